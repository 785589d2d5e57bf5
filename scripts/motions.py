"""Motions of a branch over their period, as the figures of them read them."""

import numpy as np

import figures
from plot_branch import Branches

ADMISSIBLE = ("admissible", "grazing")


class Motions(Branches):
    """A branch whose points have their states over the period."""

    def __init__(self, file):
        super().__init__(file)
        group = file["branch"]
        if "point_history_q" not in group:
            raise figures.FigureError("no /branch/point_history_q in it (the study did not ask for branch.samples)")
        self.q, self.v = group["point_history_q"][()], group["point_history_v"][()]

    def admissible(self, task):
        """Rows of the points of a task that are motions."""
        rows = self.rows("point", task)
        return rows[np.isin(self.columns["point_outcome"][rows], ADMISSIBLE)]

    def component(self, name):
        """A displacement or a velocity by its name, q0 or v1: [point_row, sample]."""
        kind, particle = name[:1], name[1:]
        if kind not in ("q", "v") or not particle.isdigit() or int(particle) >= self.q.shape[2]:
            raise figures.FigureError(
                f"no component {name}, it has q0 to q{self.q.shape[2] - 1} and v0 to v{self.q.shape[2] - 1}"
            )
        return (self.q if kind == "q" else self.v)[:, :, int(particle)]

    def check_task(self, task):
        if not 0 <= task < len(self.outcome):
            raise figures.FigureError(f"no task {task}, it has tasks 0 to {len(self.outcome) - 1}")
        if len(self.admissible(task)) == 0:
            raise figures.FigureError(f"no motion of task {task} is admissible")
        return task


def symbol(name):
    """q0 as people write it."""
    return f"${'x' if name[0] == 'q' else 'v'}_{{{int(name[1:]) + 1}}}$"
