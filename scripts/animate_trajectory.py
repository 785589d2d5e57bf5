#!/usr/bin/python3
"""Animates a chain: particles at their displacements, springs between them, obstacles, and flashes at impacts.

Datasets: /trajectory/q over /trajectory/t of one task, /trajectory/impact_time, impact_particle and impact_side.
Writes a GIF, or an MP4 where the name given with -o ends in .mp4 and ffmpeg is there. Without --to it ends where
the motion would become too fast to watch: a period of the orbit that the study starts on or, without an orbit,
the time between two impacts of the particle that hits most often, takes 25 pictures. Between samples, particles
move on straight lines.
"""

import re
import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import animation
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb, to_rgba
from matplotlib.ticker import MaxNLocator
from PIL import Image

import figures
import trajectories

DPI = 100
PER_CYCLE = 25  # pictures per cycle that the eye follows
FLASH = 6  # pictures that a flash lasts
RESTING = "#8a8a8a"  # particles that never hit
SPRING = "#9a9a9a"
TINTS = 6  # of each colour of a GIF, towards white: what smooth edges need


def palette():
    """One palette for all pictures of a GIF, so that a picture stores only what moved."""
    inks = np.array([to_rgb(ink) for ink in (figures.INK, figures.BLUE, figures.RED, RESTING, figures.FAINT)])
    tints = np.linspace(0, 1, TINTS)[:, None, None]
    colours = ((1 - tints) * inks + tints).reshape(-1, 3)
    image = Image.new("P", (1, 1))
    image.putpalette((255 * colours).round().astype(np.uint8).tobytes())
    return image


class SmallGif(animation.PillowWriter):
    """A GIF whose pictures share a palette."""

    def grab_frame(self, **options):
        super().grab_frame(**options)
        picture = self._frames[-1].convert("RGB")
        self._frames[-1] = picture.quantize(palette=palette(), dither=Image.Dither.NONE)

    def finish(self):
        pause = int(round(100 / self.fps)) * 10  # GIF counts hundredths of seconds
        first, rest = self._frames[0], self._frames[1:]
        first.save(self.outfile, save_all=True, append_images=rest, duration=pause, loop=0, optimize=False)


def last_time(motion, options):
    """Where an animation of so many pictures ends."""
    cycle = motion.period()
    hitting, counts = motion.hitting()
    if not cycle and len(hitting) and counts[0] > 1:
        times = motion.hits.time[motion.hits.particle == hitting[0]]
        cycle = (times[-1] - times[0]) / (len(times) - 1)
    if not cycle or options.end is not None:
        return motion.t[-1]
    return min(motion.t[-1], motion.t[0] + cycle * options.frames / PER_CYCLE)


def displacements(motion, times):
    """Displacements at the times [frame, particle], on straight lines between samples."""
    after = np.clip(np.searchsorted(motion.t, times), 1, len(motion.t) - 1)
    weight = ((times - motion.t[after - 1]) / (motion.t[after] - motion.t[after - 1]))[:, None]
    q = motion.q()
    return (1 - weight) * q[after - 1] + weight * q[after]


class Stage:
    """What stands still: axes, obstacles, title; and the artists that move."""

    def __init__(self, motion, q, times):
        self.q, self.times, self.count = q, times, motion.particles
        self.ring = (motion.study.word("ends") or "periodic") == "periodic" and self.count > 2
        self.fixed = motion.study.word("ends") == "fixed"
        self.figure, self.axes = plt.subplots(figsize=(8.4, 4.0), dpi=DPI, constrained_layout=True)
        self.obstacles = {name: motion.obstacles(name) for name in trajectories.SIDES}
        self._limits(motion)
        self._obstacles()
        self._movers(motion)
        self._flashes(motion)
        self.axes.set(xlabel="particle", ylabel=trajectories.LABEL)
        self.axes.xaxis.set_major_locator(MaxNLocator(integer=True, nbins=12))
        title = motion.title.replace("$", r"\$")
        self.axes.set_title(title if len(title) < 70 else title[:67] + "...", loc="left", weight="bold")
        self.digits = len(f"{times[-1]:.2f}")
        self.clock = self.axes.set_title("", loc="right", fontsize=10, family="monospace")
        self.figure.get_layout_engine().set(h_pad=0.1)
        self.show(0)
        self.figure.draw_without_rendering()
        self.figure.set_layout_engine("none")  # laid out once for all pictures

    def _limits(self, motion):
        """Room for the motion and for the obstacles that are hit or near."""
        low, high = self.q.min(), self.q.max()
        met = np.concatenate(list(motion.met_obstacles().values()))
        near = np.concatenate(list(self.obstacles.values()))
        reach = 0.5 * (high - low) or 1.0
        seen = near[(near > low - reach) & (near < high + reach)]
        shown = np.concatenate([[low, high], met[np.isfinite(met)], seen])
        pad = 0.1 * np.ptp(shown) or 0.1
        self.axes.set(ylim=(shown.min() - pad, shown.max() + pad), xlim=(-0.9, self.count - 0.1))

    def _obstacles(self):
        """A bar under, or over, each particle that has an obstacle in sight; equal neighbours share one."""
        low, high = self.axes.get_ylim()
        for name, side in trajectories.SIDES.items():
            positions = self.obstacles[name]
            for first, last in equal_runs(positions):
                if low < positions[first] < high:
                    depth = 0.05 * (high - low)
                    trajectories.hatch(self.axes, positions[first], side, first - 0.5, last + 0.5, depth)

    def _movers(self, motion):
        hits = np.zeros(self.count, bool)
        hits[motion.hitting()[0]] = True
        width = self.figure.get_figwidth() * 60 / self.count  # points between two particles
        size = np.clip(0.55 * width, 2, 13) ** 2
        colours = np.where(hits, figures.BLUE, RESTING)
        self.springs = LineCollection([], colors=SPRING, linewidths=0.9 if self.count < 100 else 0.5, zorder=2)
        self.axes.add_collection(self.springs)
        self.axes.axhline(0, color="#e4e4e4", linewidth=0.7, zorder=1)
        self.rings = self.axes.scatter([], [], s=[], facecolors="none", edgecolors=figures.RED, linewidths=2, zorder=5)
        self.discs = self.axes.scatter(np.arange(self.count), self.q[0], s=size, c=colours, linewidths=0, zorder=3)
        self.disc_size = size
        if self.fixed:
            self.axes.plot([-0.75, self.count - 0.25], [0, 0], "s", color=figures.INK, markersize=5, zorder=3)

    def _flashes(self, motion):
        """For each hit the picture in which it begins to flash, and where."""
        hits = motion.hits.pick(motion.hits.time <= self.times[-1])
        self.flash_frame = np.searchsorted(self.times, hits.time)
        known = [self.obstacles["floor" if side > 0 else "wall"][i] for i, side in zip(hits.particle, hits.side)]
        self.flash_at = np.column_stack([hits.particle, known]) if len(hits) else np.zeros((0, 2))

    def _spring_lines(self, q):
        x, y = np.arange(self.count, dtype=float), q
        if self.ring:  # half a spring at both ends: it goes on at the other one
            x = np.concatenate([[-0.5], x, [self.count - 0.5]])
            half = 0.5 * (q[0] + q[-1])
            y = np.concatenate([[half], y, [half]])
        elif self.fixed:
            x, y = np.concatenate([[-0.75], x, [self.count - 0.25]]), np.concatenate([[0], y, [0]])
        return [np.column_stack([x, y])]

    def show(self, frame):
        q = self.q[frame]
        self.discs.set_offsets(np.column_stack([np.arange(self.count), q]))
        self.springs.set_segments(self._spring_lines(q))
        age = frame - self.flash_frame
        young = (age >= 0) & (age < FLASH)
        self.rings.set_offsets(self.flash_at[young])
        self.rings.set_sizes(self.disc_size * (1.4 + 1.2 * age[young]) + 12)
        self.rings.set_edgecolors([to_rgba(figures.RED, 1 - x / FLASH) for x in age[young]])
        self.clock.set_text(f"t = {self.times[frame]:{self.digits}.2f}")
        return self.discs, self.springs, self.rings, self.clock


def equal_runs(positions):
    """Pairs (first, last) of neighbours with equal finite positions."""
    if len(positions) == 0:
        return
    starts = np.flatnonzero(np.append(True, ~(np.diff(positions) == 0)))
    for first, last in zip(starts, np.append(starts[1:], len(positions)) - 1):
        if np.isfinite(positions[first]):
            yield first, last


def animate(motion, options):
    times = np.linspace(motion.t[0], last_time(motion, options), options.frames)
    stage = Stage(motion, displacements(motion, times), times)
    return animation.FuncAnimation(stage.figure, stage.show, frames=options.frames, init_func=lambda: (), blit=False)


def write(film, path, options):
    if path.endswith(".mp4"):
        writer = animation.FFMpegWriter(fps=options.fps)
    else:
        writer = SmallGif(fps=options.fps)
    try:
        film.save(path, writer=writer, dpi=DPI)
    except OSError as trouble:
        raise figures.FigureError(f"cannot write {path}: {trouble.strerror}") from trouble
    print(path)


def output_of(options):
    """The file to write; an MP4 needs a program that may be missing."""
    if (options.output or "").endswith(".mp4"):
        if not animation.writers.is_available("ffmpeg"):
            raise figures.FigureError("an MP4 needs the program ffmpeg, which is not there: name a .gif")
        return options.output
    stem = options.output or trajectories.stem_of(options, "animation")
    return re.sub(r"\.gif$", "", stem) + ".gif"


def count_of(most):
    def count(word):
        value = int(word)
        if not 1 <= value <= most:
            raise ValueError
        return value

    return count


def main():
    parser = figures.make_parser("animation", __doc__, "STEM.gif, or STEM itself where it ends in .mp4")
    trajectories.add_options(parser)
    parser.add_argument("--frames", type=count_of(5000), default=200, metavar="N", help="pictures (default 200)")
    parser.add_argument("--fps", type=count_of(50), default=20, metavar="N", help="pictures a second (default 20)")
    options = parser.parse_args()

    def action():
        path = output_of(options)
        film = trajectories.with_motion(options, lambda motion: animate(motion, options))
        write(film, path, options)

    return figures.exit_code(options, action)


if __name__ == "__main__":
    sys.exit(main())
