import numpy as np

from emulator.geometry.warps import clock_to_coordinates, coordinates_to_clock


def test_a_mark_in_the_middle_has_coordinate_zero():
    assert np.allclose(clock_to_coordinates(np.array([[0.5]])), 0)


def test_marks_come_back():
    clock = np.sort(np.random.default_rng(0).uniform(0.02, 0.98, (50, 3)), axis=1)
    clock = clock[np.diff(clock, axis=1).min(1) > 0.01]
    assert np.allclose(coordinates_to_clock(clock_to_coordinates(clock)), clock)


def test_any_coordinates_give_ordered_marks_inside_the_performance():
    clock = coordinates_to_clock(np.random.default_rng(1).normal(0, 8, (500, 4)))
    edges = np.concatenate([np.zeros((500, 1)), clock, np.ones((500, 1))], axis=1)
    assert np.all(np.diff(edges, axis=1) > 0)


def test_a_mark_on_the_very_end_has_a_finite_coordinate():
    assert np.all(np.isfinite(clock_to_coordinates(np.array([[0.0, 1.0]]))))


def test_a_task_without_marks_has_none():
    assert coordinates_to_clock(clock_to_coordinates(np.empty((5, 0)))).shape == (5, 0)
