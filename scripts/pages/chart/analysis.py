# SPDX-License-Identifier: Apache-2.0
"""What can be read off the points of a chart. A point is a pair (x, y)."""
from dataclasses import dataclass


def beats(a, b):
    """True if `a` is at most as large as `b` in both coordinates and smaller in one."""
    return a[0] <= b[0] and a[1] <= b[1] and a != b


def pareto_front(points):
    """The indices of the points that no other point beats, by ascending x."""
    return [i for i in sorted(range(len(points)), key=lambda i: points[i][0]) if not any(beats(other, points[i]) for other in points)]


def breakdown_point(points, times=2):
    """The point at which y first reaches `times` its value at the first point, interpolated linearly; None if it never does. The
    points must be in the order of ascending x."""
    if not points or points[0][1] <= 0:
        return None
    limit = times * points[0][1]
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if y1 >= limit:
            return x0 + (x1 - x0) * (limit - y0) / (y1 - y0), limit
    return None


@dataclass
class Cluster:
    """Marks that touch. They are moved as one to the mean of their wanted places."""
    total: float  # sum over the marks of the place of the first one that would suit the mark
    count: int = 1

    def first(self, gap, low, high):
        """The place of the first mark."""
        return max(low, min(self.total / self.count, high - gap * (self.count - 1)))


def spread_apart(marks, gap, low, high):
    """Moves marks on a line apart until neighbours have a distance of at least `gap`. The order is kept, the sum of squared
    displacements is minimal, and all marks stay between `low` and `high` if they fit."""
    order = sorted(range(len(marks)), key=lambda i: marks[i])
    clusters = []
    for i in order:
        clusters.append(Cluster(marks[i]))
        while len(clusters) > 1:
            before, last = clusters[-2:]
            if last.first(gap, low, high) >= before.first(gap, low, high) + gap * before.count:
                break
            before.total += last.total - gap * before.count * last.count
            before.count += last.count
            clusters.pop()
    places = [cluster.first(gap, low, high) + gap * k for cluster in clusters for k in range(cluster.count)]
    return [place for _, place in sorted(zip(order, places))]
