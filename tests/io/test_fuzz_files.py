"""Runs benchmarks/fuzz_files.py with fewer cases: damaged and malicious files open or are refused."""

import runpy
import warnings
from pathlib import Path

SCRIPT = Path(__file__).parents[2] / "benchmarks" / "fuzz_files.py"


def test_every_file_opens_or_is_refused_in_one_sentence():
    fuzzer = runpy.run_path(str(SCRIPT))["Fuzzer"]()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for seed in range(2000):
            fuzzer.run(seed)
    for kind, share in (("akap", 0.1), ("pose", 0.03), ("akaprec", 0.1)):
        opened, refused = fuzzer.counts[f"{kind} opened"], fuzzer.counts[f"{kind} refused"]
        assert share * (opened + refused) < opened < refused, "some damage does no harm, most does"
    assert len(fuzzer.messages) > 250
