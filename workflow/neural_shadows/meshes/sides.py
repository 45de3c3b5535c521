"""Sides of triangles, by the edges that they share."""

import numpy as np
from numba import njit


@njit(cache=True, nogil=True)
def sides_by_edges(faces, count):
    """Sort the sides of triangles (F, 3) by their edges.

    Side 3 f + k goes from corner k of face f to the next.

    Args:
        count: of vertices.

    Returns:
        firsts: (count + 1,) int64, each vertex's first side: of edges whose lower end it is.
        sides: (3 F,) int32, those of a vertex by their other ends, those of an edge by k and f.
        others: (3 F,) int32, the other ends.
    """
    # Counted twice, by the other ends first: a hub of many edges needs no sort of its own.
    starts, firsts = np.zeros(count + 1, np.int64), np.zeros(count + 2, np.int64)
    for f in range(len(faces)):
        for k in range(3):
            a, b = faces[f, k], faces[f, (k + 1) % 3]
            starts[max(a, b) + 1] += 1
            firsts[min(a, b) + 2] += 1
    starts, firsts = np.cumsum(starts), np.cumsum(firsts)
    by_others, sides = np.empty(3 * len(faces), np.int32), np.empty(3 * len(faces), np.int32)
    others = np.empty(3 * len(faces), np.int32)
    for k in range(3):
        for f in range(len(faces)):
            other = max(faces[f, k], faces[f, (k + 1) % 3])
            by_others[starts[other]] = 3 * f + k
            starts[other] += 1
    for side in by_others:
        f, k = side // 3, side % 3
        a, b = faces[f, k], faces[f, (k + 1) % 3]
        at = firsts[min(a, b) + 1]
        sides[at], others[at] = side, max(a, b)
        firsts[min(a, b) + 1] += 1
    return firsts[:-1], sides, others


@njit(cache=True, nogil=True)
def edges_by_uses(faces, count):
    """Count edges of one, two and more triangles."""
    firsts, _, others = sides_by_edges(faces, count)
    uses = np.zeros(3, np.int64)
    for vertex in range(count):
        n, end = firsts[vertex], firsts[vertex + 1]
        while n < end:
            following = n + 1
            while following < end and others[following] == others[n]:
                following += 1
            uses[min(following - n, 3) - 1] += 1
            n = following
    return uses


@njit(cache=True, nogil=True)
def count_bodies(faces, count):
    """Count sets of vertices joined by triangles."""
    roots, bodies = np.arange(count), count
    for f in range(len(faces)):
        for k in range(2):
            a, b = root(roots, faces[f, k]), root(roots, faces[f, k + 1])
            if a != b:
                roots[max(a, b)] = min(a, b)
                bodies -= 1
    return bodies


@njit(cache=True, nogil=True)
def root(roots, vertex):
    """Root of a vertex's set in a union-find forest, whose paths it halves."""
    while roots[vertex] != vertex:
        roots[vertex] = roots[roots[vertex]]
        vertex = roots[vertex]
    return vertex
