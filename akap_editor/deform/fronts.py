"""The symbolic phase of a multifrontal Cholesky factorization: the fronts of a sparsity pattern.

See `multifrontal` for what a front is. This phase runs once for each mesh (paper, section 3.1).
"""

from typing import NamedTuple

import numpy as np

from ..geometry.jit import compiled
from ..geometry.validation import Indices, Ints


class Fronts(NamedTuple):  # numba's caches on disk refer to this name: renamed, they fail to load
    """The symbolic factorization of a sparsity pattern: everything about the factors but the numbers.

    There are f fronts. Each ``..._starts`` (f + 1,) gives the range of a front in the array named after it.
    Arrays are int32 unless noted.

    starts: the own unknowns of each front, which are consecutive.
    row_starts, rows: (r,) uint32, the later unknowns that each front affects, ascending.
    child_starts, children: the fronts whose updates a front takes up.
    run_starts, runs: (q, 3) where an update goes: first and last + 1 of a run of its rows, and what has to be
    added for the rows of the parent's front.
    entry_starts, entries: (z,) uint32, the place of each nonzero in its front, a full matrix row by row.
    factor_starts: int64, where the rows of U start. They are packed: each begins at the diagonal.
    update_starts: (f,) int64, the place of each update on the stack, packed in the same way.
    """

    starts: Ints
    row_starts: Ints
    rows: Indices
    child_starts: Ints
    children: Ints
    run_starts: Ints
    runs: Ints
    entry_starts: Ints
    entries: Indices
    factor_starts: Ints
    update_starts: Ints


def column_starts(columns: Ints, count: int) -> Ints:
    """(count + 1,) int32, where the nonzeros of each column start, given ``columns`` (z,), ascending."""
    starts = np.zeros(count + 1, dtype=np.int32)
    np.cumsum(np.bincount(columns, minlength=count), out=starts[1:])
    return starts


class SymbolicCholesky:
    """The symbolic phase: prepares factorizations of matrices with one sparsity pattern.

    rows, columns: (z,) int32 of the nonzeros in the lower triangle, sorted by column; width: number of
    unknowns of a vertex; those of vertex i start at width i. starts: (f + 1,) the groups of vertices that are
    eliminated together, see `Dissection`; any groups of consecutive vertices give right factors.

    fronts: the result; factor_size, stack_size: numbers of entries; largest_front: number of its rows.
    """

    def __init__(self, rows: Ints, columns: Ints, width: int, starts: Ints) -> None:
        starts = starts.astype(np.int32)
        count = len(starts) - 1
        nonzero_starts = column_starts(columns, width * int(starts[-1]))
        row_starts, front_rows, parents, run_starts, runs, entries = _analyze(
            width, starts, nonzero_starts, rows
        )
        children = np.argsort(parents, kind="stable").astype(np.int32)
        child_starts = np.searchsorted(parents[children], np.arange(count + 1)).astype(np.int32)
        orphans = child_starts[0]  # fronts without a parent, sorted first
        own, below = (width * np.diff(ends).astype(np.int64) for ends in (starts, row_starts))
        sizes = own * (own + below) - own * (own - 1) // 2
        factor_starts = np.concatenate([[0], np.cumsum(sizes)])
        children = children[orphans:]
        child_starts -= orphans
        update_starts, self.stack_size = _place_updates(child_starts, children, below)
        unknowns = (width * front_rows[:, None] + np.arange(width)).astype(np.uint32).ravel()
        self.fronts = Fronts(
            width * starts, width * row_starts, unknowns, child_starts, children, run_starts, runs,
            nonzero_starts[width * starts], entries.view(np.uint32), factor_starts, update_starts,
        )  # fmt: skip
        self.factor_size = int(factor_starts[-1])
        self.largest_front = int((own + below).max())


@compiled
def _analyze(
    width: int, starts: Ints, column_starts: Ints, rows: Ints
) -> tuple[Ints, Ints, Ints, Ints, Ints, Ints]:
    """All loops in one function: loading a compiled one takes milliseconds. See those that it calls."""
    row_starts, front_rows, parents = _find_rows(width, starts, column_starts, rows)
    run_starts, runs, entries = _find_places(
        width, starts, row_starts, front_rows, parents, column_starts, rows
    )
    return row_starts, front_rows, parents, run_starts, runs, entries


@compiled
def _find_rows(width: int, starts: Ints, column_starts: Ints, rows: Ints) -> tuple[Ints, Ints, Ints]:
    """The later vertices of each front, and its parent: the front of the first of them, -1 if there is
    none."""
    n, count = starts[-1], len(starts) - 1
    front_of = np.empty(n, dtype=np.int32)
    for s in range(count):
        for v in range(starts[s], starts[s + 1]):
            front_of[v] = s
    parents, seen = np.full(count, -1, dtype=np.int32), np.full(n, -1, dtype=np.int32)
    first_child, sibling = np.full(count, -1, dtype=np.int32), np.full(count, -1, dtype=np.int32)
    row_starts, result = np.zeros(count + 1, dtype=np.int32), np.empty(16 * n, dtype=np.int32)
    end = 0
    for s in range(count):
        begin, last = end, starts[s + 1]
        if begin + n > len(result):
            longer = np.empty(2 * len(result) + n, dtype=np.int32)
            for k in range(begin):
                longer[k] = result[k]
            result = longer
        for k in range(column_starts[width * starts[s]], column_starts[width * last]):
            v = rows[k] // width
            if v >= last and seen[v] != s:
                seen[v] = s
                result[end] = v
                end += 1
        child = first_child[s]
        while child >= 0:
            for k in range(row_starts[child], row_starts[child + 1]):
                v = result[k]
                if v >= last and seen[v] != s:
                    seen[v] = s
                    result[end] = v
                    end += 1
            child = sibling[child]
        _sort(result[begin:end])
        row_starts[s + 1] = end
        if end > begin:
            parent = front_of[result[begin]]
            parents[s], sibling[s], first_child[parent] = parent, first_child[parent], s
    return row_starts, result[:end].copy(), parents


@compiled
def _sort(values: Ints) -> None:
    """Sort in place, by Shell's method: numba's own sort takes a second to compile."""
    for gap in (1750, 701, 301, 132, 57, 23, 10, 4, 1):  # Ciura's sequence
        for k in range(gap, len(values)):
            value, at = values[k], k
            while at >= gap and values[at - gap] > value:
                values[at] = values[at - gap]
                at -= gap
            values[at] = value


@compiled
def _find_places(
    width: int,
    starts: Ints,
    row_starts: Ints,
    front_rows: Ints,
    parents: Ints,
    column_starts: Ints,
    rows: Ints,
) -> tuple[Ints, Ints, Ints]:
    """``run_starts``, ``runs`` and ``entries`` of `Fronts`; column_starts, rows: of the nonzeros."""
    n, count = starts[-1], len(starts) - 1
    place = np.empty(n, dtype=np.int32)  # of a vertex in the front at hand
    entries = np.empty(len(rows), dtype=np.int32)
    run_counts, all_runs = np.zeros(count, dtype=np.int32), np.empty((len(front_rows), 3), dtype=np.int32)
    first_child, sibling = np.full(count, -1, dtype=np.int32), np.full(count, -1, dtype=np.int32)
    for s in range(count):
        own, below = starts[s + 1] - starts[s], row_starts[s + 1] - row_starts[s]
        size = width * (own + below)
        for v in range(starts[s], starts[s + 1]):
            place[v] = v - starts[s]
        for k in range(below):
            place[front_rows[row_starts[s] + k]] = own + k
        for column in range(width * own):
            j = width * starts[s] + column
            for k in range(column_starts[j], column_starts[j + 1]):
                entries[k] = column * size + width * place[rows[k] // width] + rows[k] % width
        child = first_child[s]
        while child >= 0:
            begin, q = row_starts[child], 0
            for k in range(row_starts[child + 1] - begin):
                shift = width * (place[front_rows[begin + k]] - k)
                if q == 0 or all_runs[begin + q - 1, 2] != shift:
                    all_runs[begin + q, 0], all_runs[begin + q, 2] = width * k, shift
                    q += 1
                all_runs[begin + q - 1, 1] = width * (k + 1)
            run_counts[child] = q
            child = sibling[child]
        if parents[s] >= 0:
            sibling[s], first_child[parents[s]] = first_child[parents[s]], s
    run_starts = np.zeros(count + 1, dtype=np.int32)
    for s in range(count):
        run_starts[s + 1] = run_starts[s] + run_counts[s]
    runs = np.empty((run_starts[count], 3), dtype=np.int32)
    for s in range(count):
        for q in range(run_counts[s]):
            for part in range(3):
                runs[run_starts[s] + q, part] = all_runs[row_starts[s] + q, part]
    return run_starts, runs, entries


@compiled
def _place_updates(child_starts: Ints, children: Ints, below: Ints) -> tuple[Ints, int]:
    """The place of each front's update on the stack, (f,), and how large the stack gets."""
    count = len(below)
    update_starts, is_used = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.bool_)
    stack, depth, largest = np.empty(count, dtype=np.int32), 0, 0
    for s in range(count):
        for k in range(child_starts[s], child_starts[s + 1]):
            is_used[children[k]] = True
        while depth > 0 and is_used[stack[depth - 1]]:
            depth -= 1
        if depth > 0:
            top = stack[depth - 1]
            update_starts[s] = update_starts[top] + below[top] * (below[top] + 1) // 2
        stack[depth] = s
        depth += 1
        largest = max(largest, update_starts[s] + below[s] * (below[s] + 1) // 2)
    return update_starts, largest
