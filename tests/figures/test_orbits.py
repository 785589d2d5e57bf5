"""Figures of results of kind orbits: what they draw, and what they cannot draw."""

import numpy as np
import pytest
from album import assert_among, column
from shelf import FAMILY, broken, over_gamma, ring

import ricochet

STUDIES = {
    "family": FAMILY,
    "poles": ring("costs 5 $ and 6 $", over_gamma("from: 0, to: 1.2, points: 121"), ", special_points: true"),
    "stateless": ring("no states", over_gamma("from: 0, to: 0.19, points: 3"), ", states: false"),
}
MADE = {"broken": broken("poles", "orbits", [0, 5, 6, 40], ("failed", "singular"))}

# figure, result, options
PICTURES = [
    ("modes", "family", {}),
    ("modes", "poles", {"all": True, "curves": 20}),
    ("modes", "broken", {}),
    ("modes", "family", {"style": {"column": True}}),
]
# figure, result, options, words of the message
REFUSALS = [
    ("modes", "stateless", {}, "it has no orbits/q (the study did not ask for orbit.states)"),
]


@pytest.mark.parametrize("figure, name, options", PICTURES)
def test_all_of_it_fits(picture, figure, name, options):
    picture(figure, name, **options).expect_whole()


@pytest.mark.parametrize("figure, name, options, words", REFUSALS)
def test_refusals_say_what_is_missing(picture, figure, name, options, words):
    with pytest.raises(ricochet.ResultError) as refused:
        picture(figure, name, **options)
    assert words in refused.value.reason


def test_modes_are_the_stored_states_against_the_particle(picture, results):
    drawn = picture("modes", "family")
    for panel, name in enumerate(("q", "v")):
        states = column(results["family"], f"orbits/{name}")
        wanted = np.column_stack([np.tile(np.arange(6), len(states)), states.ravel()])
        assert_among(wanted, drawn.offsets(panel))
    assert drawn.heading == ["a family", "ring of 6 particles, floor at $-1$, $T = 1.5\\,\\pi$"]
    assert drawn.labels(1) == ("particle", "velocity $v$ at $t = 0^+$")
    assert drawn.legend == ["hits at $t = 0$", "floor"] and drawn.notes == ""


def test_modes_leave_out_what_is_not_admissible(picture, results):
    admissible = column(results["poles"], "orbits/outcome") == "admissible"
    assert len(picture("modes", "broken").offsets()) < 6 * admissible.sum()
    assert "20 of" in picture("modes", "poles", all=True, curves=20).notes
