"""Compiles the loops of the package, so that several workers of the tests need not do it at once."""

from multiprocessing import Process

from akap_editor.deform import precompile as solver
from akap_editor.overlap import precompile as overlaps

if __name__ == "__main__":
    processes = [Process(target=target) for target in (solver.precompile, overlaps.precompile)]
    for process in processes:
        process.start()
    for process in processes:
        process.join()
