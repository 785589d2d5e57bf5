"""A picture depends on what a study says, not on how it says it: block style, flow style and --set draw the same."""

import numpy as np
import pytest

import ricochet
import ricochet.plot

BLOCK = """kind: {kind}
title: a study
model:
  type: chain
  particles: 4
  ends: fixed
  gamma: 0.05
  floor:
    - -1
    - null
    - -0.8
    - -2
{rest}"""
FLOW = """{{kind: {kind}, title: a study,
  model: {{type: chain, particles: 4, ends: fixed, gamma: 0.05, floor: [-1, null, -0.8, -2]}},
{rest}}}
"""
SET = """kind: {kind}
title: a study
model: {{type: chain, particles: 4, gamma: 0}}
{rest}"""
ASSIGNED = ("--set", "model.ends=fixed", "--set", "model.gamma=0.05", "--set", "model.floor=[-1, null, -0.8, -2]")
RESTS = {
    "orbits": (
        "orbit:\n  period: 1.5 pi\n  at_start:\n    - 2\n"
        "sweep:\n  - parameter: model.gamma\n    values:\n      - 0.01\n      - 0.02\n      - 0.05\n",
        "orbit: {period: 1.5 pi, at_start: [2]}, sweep: [{parameter: model.gamma, values: [0.01, 0.02, 0.05]}]",
    ),
    "trajectory": (
        "start:\n  v:\n    - 1.4\n    - 0\n    - 1.2\n    - 0.5\ntime:\n  duration: 20\n  samples: 201\n",
        "start: {v: [1.4, 0, 1.2, 0.5]}, time: {duration: 20, samples: 201}",
    ),
}
FIGURES = [("orbits", "modes"), ("orbits", "sweep"), ("trajectory", "trajectory"), ("trajectory", "phase")]


@pytest.fixture(scope="module")
def forms(ricochet):
    """{kind: the paths of the results of all forms of one study}."""
    found = {}
    for kind, (block, flow) in RESTS.items():
        folder, found[kind] = ricochet.new_folder(), []
        texts = [(BLOCK.format(kind=kind, rest=block), ()), (FLOW.format(kind=kind, rest=flow), ()),
                 (SET.format(kind=kind, rest=block), ASSIGNED)]  # fmt: skip
        for number, (text, words) in enumerate(texts):
            (folder / f"{number}.yaml").write_text(text)
            ricochet.run(f"{number}.yaml", *words, cwd=folder).expect_done()
            found[kind].append(folder / f"{number}.h5")
    return found


def contents(figure):
    """Texts, and numbers of all lines, areas and dots of a figure."""
    numbers = []
    for axes in figure.axes:
        numbers += [line.get_xydata() for line in axes.lines]
        numbers += [path.vertices for artist in axes.collections for path in artist.get_paths()]
        numbers += [np.asarray(artist.get_offsets()) for artist in axes.collections]
    words = [text.get_text() for text in figure.texts]
    words += [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    return words, numbers


@pytest.mark.parametrize("kind, name", FIGURES)
def test_all_forms_of_a_study_give_the_same_picture(forms, kind, name):
    drawn = []
    for path in forms[kind]:
        with ricochet.open(path) as result:
            drawn.append(contents(ricochet.plot.CATALOGUE[name].draw(result)))
    words, numbers = drawn[0]
    assert len(numbers) > 4 and any("floor" in word for word in words), words
    for other_words, other_numbers in drawn[1:]:
        assert other_words == words and len(other_numbers) == len(numbers)
        assert all(np.array_equal(one, other, equal_nan=True) for one, other in zip(numbers, other_numbers))
