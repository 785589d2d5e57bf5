"""Pictures of a motion one after another, and the files that hold them: GIF with a small palette, or MP4."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property

import numpy as np
from matplotlib import animation
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from PIL import Image

from ricochet.plot import look
from ricochet.plot.sheet import FigureError, settings
from ricochet.sweep import Array

_TINTS = 6  # of each colour, towards white: what smooth edges need
_UNCHANGED = 255  # the colour of pixels that stay as they were


class Film:
    """A figure that `show(k)` changes into the k-th of its pictures.

    figure    matplotlib's figure
    show      returns the artists that it changes, and those that lie over them, from the back to the front
    pictures  how many there are
    fps       pictures a second
    dpi       pixels per inch
    source    the result that it is drawn from
    """

    def __init__(
        self, figure: Figure, show: Callable[[int], Sequence[Artist]], pictures: int, fps: int, dpi: float, source: str
    ):
        self.figure, self.show = figure, show
        self.pictures, self.fps, self.dpi, self.source = pictures, fps, dpi, source

    @cached_property
    def animation(self) -> animation.FuncAnimation:
        """matplotlib's animation of it: `IPython.display.HTML(film.animation.to_jshtml())` in a notebook."""
        return animation.FuncAnimation(
            self.figure, self.show, frames=self.pictures, init_func=lambda: (), interval=1000 / self.fps, blit=False
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a .gif, or an .mp4 where the program ffmpeg is there."""
        path = os.fspath(path)
        write = {".gif": self._write_gif, ".mp4": self._write_mp4}.get(os.path.splitext(path)[1])
        if write is None:
            raise FigureError(self.source, f"an animation is written as .gif or .mp4, not as {path}")
        with settings():
            write(path)

    def _write_mp4(self, path: str) -> None:
        if not animation.FFMpegWriter.isAvailable():
            raise FigureError(
                self.source, f"{path} needs the program ffmpeg, which is not there; a .gif does without it"
            )
        try:
            self.animation.save(path, writer=animation.FFMpegWriter(fps=self.fps), dpi=self.dpi)
        except subprocess.CalledProcessError as trouble:
            raise FigureError(self.source, f"ffmpeg did not write {path}: exit code {trouble.returncode}") from trouble

    def _write_gif(self, path: str) -> None:
        with open(path, "wb") as file:
            first, *rest = _changes(self._drawn())
            pause = round(100 / self.fps) * 10  # GIF counts hundredths of seconds
            first.save(
                file, format="GIF", save_all=True, append_images=rest, duration=pause, loop=0, optimize=False,
                transparency=_UNCHANGED, disposal=1,
            )  # fmt: skip

    def _drawn(self) -> Iterator[Array]:
        """The pixels of the pictures [height, width, 3]. What stands still is drawn once."""
        canvas, dpi = self.figure.canvas, self.figure.dpi
        own = FigureCanvasAgg(self.figure)
        self.figure.dpi = self.dpi
        try:
            moving = self.show(0)
            _set_animated(moving, True)
            own.draw()
            _set_animated(moving, False)
            still = own.copy_from_bbox(self.figure.bbox)
            for k in range(self.pictures):
                own.restore_region(still)
                for artist in self.show(k):
                    artist.draw(own.get_renderer())
                yield np.array(own.buffer_rgba())[:, :, :3]
        finally:
            self.figure.dpi = dpi
            self.figure.set_canvas(canvas)


def _set_animated(artists: Iterable[Artist], animated: bool) -> None:
    """Animated artists are left out when a figure is drawn."""
    for artist in artists:
        artist.set_animated(animated)


def _changes(drawn: Iterable[Array]) -> list[Image.Image]:
    """Pictures in the colours of the palette, behind the first one with nothing but the pixels that change."""
    palette = _palette()
    shown: Array | None = None
    pictures = []
    for pixels in drawn:
        colours = np.asarray(Image.fromarray(pixels).quantize(palette=palette, dither=Image.Dither.NONE))
        changed = colours if shown is None else np.where(colours == shown, np.uint8(_UNCHANGED), colours)
        shown = colours
        pictures.append(Image.fromarray(changed, "P"))
        pictures[-1].putpalette(palette.getpalette())
    return pictures


def _palette() -> Image.Image:
    """An image whose palette holds tints of the inks of films; all pictures share it."""
    inks = np.array([to_rgb(ink) for ink in (look.INK, look.BLUE, look.RED, look.FAINT)])
    tints = np.linspace(0, 1, _TINTS)[:, None, None]
    used = ((1 - tints) * inks + tints).reshape(-1, 3)
    colours = np.tile([1.0, 0.0, 1.0], (256, 1))  # the others are far from all inks: none is picked
    colours[: len(used)] = used
    image = Image.new("P", (1, 1))
    image.putpalette((255 * colours).round().astype(np.uint8).tobytes())
    return image
