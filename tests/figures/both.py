"""Two tests that every file of figures has, of its PICTURES and REFUSALS: a file imports them, and conftest.py gives each
its cases."""

import pytest

import ricochet


def test_all_of_it_fits(picture, figure_fits, name, options):
    picture(figure_fits, name, **options).expect_whole()


def test_refusals_say_what_is_missing(picture, figure_refused, name, options, words):
    with pytest.raises(ricochet.ResultError) as refused:
        picture(figure_refused, name, **options)
    assert words in refused.value.reason


__all__ = ["test_all_of_it_fits", "test_refusals_say_what_is_missing"]
