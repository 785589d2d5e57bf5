"""Pictures of results, each drawn once: what its lines, markers, labels and legends hold, and whether all of it fits.

Numbers of pictures are those that matplotlib holds; they are compared with the result's file as h5py reads it.
"""

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
matplotlib.rcParams["figure.max_open_warning"] = 0  # an album keeps its pictures
import matplotlib.pyplot as plt  # noqa: E402

import ricochet  # noqa: E402
import ricochet.plot  # noqa: E402


class Album:
    """Pictures of the results on a shelf."""

    def __init__(self, shelf):
        self.shelf, self._drawn = shelf, {}

    def __call__(self, figure, name, style=None, **options):
        """The picture `figure` ("grazing-curve") of the result `name`, drawn when it is first asked for."""
        key = (figure, name, repr(style), repr(sorted(options.items())))
        if key not in self._drawn:
            with ricochet.open(self.shelf[name]) as result, ricochet.plot.style(**(style or {})):
                drawn = ricochet.plot.CATALOGUE[figure].draw(result, **options)
                self._drawn[key] = Picture(getattr(drawn, "figure", drawn))  # a film has a figure
        return self._drawn[key]

    def close(self):
        plt.close("all")


class Picture:
    """A figure of matplotlib, in words and numbers."""

    def __init__(self, figure):
        self.figure = figure
        self.axes = figure.axes  # the main panel first

    # --- words ---

    @property
    def heading(self):
        """Lines above the panels, from the top."""
        lines = sorted(self._texts("top"), key=lambda text: -text.get_position()[1])
        return [text.get_text() for text in lines]

    @property
    def notes(self):
        return " ".join(text.get_text() for text in sorted(self._texts("bottom"), key=lambda text: -text.get_position()[1]))

    def _texts(self, place):
        return [text for text in self.figure.texts if text.get_va() == place]

    @property
    def legend(self):
        """Labels of the legends below the panels and in them."""
        legends = [*self.figure.legends, *(axes.get_legend() for axes in self.axes if axes.get_legend())]
        return [text.get_text() for legend in legends for text in legend.get_texts()]

    def labels(self, panel=0):
        """(label of the horizontal axis, of the vertical axis)."""
        return self.axes[panel].get_xlabel(), self.axes[panel].get_ylabel()

    # --- numbers ---

    def points(self, panel=0):
        """Points of all lines and markers in data coordinates: [point, 2]."""
        axes = self.axes[panel]
        lines = [line.get_xydata() for line in axes.lines if line.get_transform().contains_branch(axes.transData)]
        return np.concatenate([np.empty((0, 2)), *lines])

    def offsets(self, panel=0):
        """Places of the dots of scatter plots: [point, 2]."""
        return np.concatenate([np.empty((0, 2)), *(np.asarray(c.get_offsets()) for c in self.axes[panel].collections)])

    # --- whether it fits ---

    def expect_whole(self):
        """Nothing sticks out of the picture, legends do not lie on panels, and no text of the heading on another."""
        self.figure.draw_without_rendering()
        renderer = self.figure.canvas.get_renderer()
        width, height = self.figure.bbox.width, self.figure.bbox.height
        box = self.figure.get_tightbbox(renderer).transformed(self.figure.dpi_scale_trans)
        assert box.x0 > -1 and box.y0 > -1 and box.x1 < width + 1 and box.y1 < height + 1, f"sticks out: {box}"
        panels = [axes.get_tightbbox(renderer) for axes in self.axes if axes.axison and axes.get_visible()]
        around = [text.get_window_extent(renderer) for text in self.figure.texts]
        around += [legend.get_window_extent(renderer) for legend in self.figure.legends]
        for i, one in enumerate(around):
            for other in panels + around[i + 1 :]:
                assert not overlap(one, other), f"{one} lies on {other}"
        return self


def overlap(one, other, slack=2):
    """Whether two boxes share more than a few pixels each way."""
    return (
        min(one.x1, other.x1) - max(one.x0, other.x0) > slack and min(one.y1, other.y1) - max(one.y0, other.y0) > slack
    )


# --- numbers of files ---


def column(path, name):
    """A data set, of an enum its names."""
    with h5py.File(path, "r") as file:
        data = file[name]
        kinds = h5py.check_enum_dtype(data.dtype)
        if kinds is None:
            return data[()]
        names = {value: word for word, value in kinds.items()}
        return np.vectorize(names.get, otypes=[object])(data[()])


def assert_among(wanted, have):
    """Every wanted point [point, 2] is one of those that there are."""
    known = set(map(tuple, np.asarray(have).tolist()))
    missing = [row for row in map(tuple, np.asarray(wanted).tolist()) if row not in known]
    assert not missing, f"{len(missing)} of {len(wanted)} points are not there, {missing[0]} for one"


def counts(words):
    return dict(zip(*np.unique(np.asarray(words, str), return_counts=True)))
