"""The sheet of a figure: measured text, lines that fit, legends in the room that there is."""

import matplotlib.pyplot as plt
import pytest
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.textpath import TextPath
from shelf import FAMILY

import ricochet
import ricochet.plot
from ricochet.plot.sheet import Sheet, fitted_legend, plain, settings, text_width, words_of, wrapped

STUDIES = {"family": FAMILY}
TEXTS = ["a chain", r"$\lambda = 0.63 + 0.41\,i$, $|\lambda| = 0.75$", "x", r"costs 5 \$ and 6 \$", "", "  "]
FORMULA = r"where $c_i = \eta L^i \xi$ is negative for some $i \geq 20$, and $c_0 > 0$, by $L = \Phi_T$"


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("weight", ["normal", "bold"])
def test_text_is_as_wide_as_its_curves(text, weight):
    path = TextPath((0, 0), text, size=10, prop=FontProperties(weight=weight))
    assert text_width(text, 10, weight) == pytest.approx(path.get_extents().width if len(path.vertices) else 0, abs=0.3)


def test_mathematics_is_part_of_a_word():
    assert words_of(FORMULA)[:3] == ["where", r"$c_i = \eta L^i \xi$", "is"]
    assert words_of(plain("from 5 $ to 6 $ or $7 each")) == [
        "from", "5", r"\$", "to", "6", r"\$", "or", r"\$7", "each"]  # fmt: skip
    assert words_of("a  title\nof two lines") == ["a", "title", "of", "two", "lines"]


@pytest.mark.parametrize("room", [60, 90, 150, 400])
def test_lines_fit_and_hold_all_words(room):
    lines = wrapped(words_of(FORMULA), " ", room, {"size": 10})
    assert " ".join(lines) == FORMULA
    for line in lines:
        assert line.count("$") % 2 == 0
        assert text_width(line, 10) <= room or len(words_of(line)) == 1
    first = [words_of(line)[0] for line in lines[1:]]
    for line, word in zip(lines, first):
        assert text_width(f"{line} {word}", 10) > room - 3, "a line has room for the next word"


@pytest.mark.parametrize("count, room", [(1, 3.0), (5, 8.0), (9, 8.0), (9, 3.2), (4, 1.0)])
def test_a_legend_has_the_columns_that_fit(count, room):
    figure = plt.figure(figsize=(8.6, 4))
    entries = [Line2D([], [], label=f"entry {k} of $c_{{{k}}}$") for k in range(count)]
    with settings():
        legend, height = fitted_legend(figure, entries, room)
        box = legend.get_window_extent()
    plt.close(figure)
    assert figure.legends == [legend] and [text.get_text() for text in legend.get_texts()] == [
        entry.get_label() for entry in entries
    ]
    assert box.width <= room * figure.dpi or legend._ncols == 1
    assert box.height / figure.dpi <= height <= box.height / figure.dpi + 0.1
    rows = -(-count // legend._ncols)
    assert rows * legend._ncols - count < rows, "an empty column"


def test_a_heading_is_never_broken_inside_mathematics(results):
    with ricochet.open(results["family"]) as result:
        for width in (2.0, 3.4, 6.0):
            with ricochet.plot.style(width=width, title="5 $ and 6 $ for " + "long " * 12), settings():
                sheet = Sheet(result, 8, 4)
                sheet.panel()
                sheet.note(FORMULA)
                figure = sheet.finish(FORMULA)
            lines = [text.get_text() for text in figure.texts]
            plt.close(figure)
            assert len(lines) >= (9 if width == 2 else 5) and all(
                line.replace(r"\$", "").count("$") % 2 == 0 for line in lines
            )


def test_a_figure_that_is_not_written_leaves_the_one_before(folder, monkeypatch):
    figure, path = plt.figure(), folder / "a.png"
    ricochet.plot.save(figure, path)
    before = path.read_bytes()
    monkeypatch.setattr(figure, "savefig", lambda *words, **options: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        ricochet.plot.save(figure, path)
    plt.close(figure)
    assert path.read_bytes() == before and [each.name for each in folder.iterdir()] == ["a.png"]
