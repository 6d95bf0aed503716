"""The standard points, pinned: the solver's side samples exactly these."""

import pytest

from edgeline_fem.standard_points import CURVES, contact_line, depths, end_distances, standard_curves


def test_distances_from_the_end():
    assert end_distances(5.0) == [0.0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0,
                                  1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0]
    # Lengths come out of divisions: rounding must not make two points of one.
    assert len(end_distances(5.0 * (1.0 + 1e-12))) == len(end_distances(5.0))
    assert end_distances(20.0)[20:] == [6.5, 8.0, 10.0, 13.0, 16.0, 20.0]
    assert end_distances(120.0)[22:] == [10.0, 13.0, 16.0, 20.0, 25.0, 32.0, 40.0, 50.0, 64.0, 80.0, 100.0,
                                         120.0]


def test_depths():
    z = depths()
    assert len(z) == 50
    assert z[:4] == [0.0, 0.02, 0.05, 0.1]
    assert z[31:34] == pytest.approx([1.5, 1.6, 1.7])
    assert z[-4:] == pytest.approx([3.0, 3.5, 4.0, 5.0])


def test_curves_of_a_longer_block_go_past_the_roller():
    curves = standard_curves(5.0, 10.0)
    assert tuple(curves) == CURVES
    y = [p[1] for p in curves["surface-along-y"]]
    assert y[:20] == contact_line(5.0)
    assert y[20] == 5.02 and y[-1] == 8.0 and len(y) == 37
    assert [p[1] for p in standard_curves(5.0, 6.0)["along-y-0.5C"]][-2:] == [5.8, 6.0]
    rounded = standard_curves(5.0, 7.0 * (1.0 + 1e-12))["along-y-0.5C"]
    assert [p[1] for p in rounded][-2:] == pytest.approx([6.5, 7.0])


def test_curves_of_a_flush_block_end_with_the_roller():
    curves = standard_curves(5.0, 5.0 * (1.0 + 1e-12))
    assert curves["surface-along-y"][-1] == (0.0, 5.0, 0.0)
    assert [p[0] for p in curves["surface-along-x"]][-5:] == [1.5, 1.75, 2.0, 2.5, 3.0]
    assert curves["depth-0.9"][0][1] == 4.5


def test_depth_profiles_stand_off_the_planes_of_symmetry_too():
    curves = standard_curves(5.0, 10.0)
    for place, y in (("centre", 0.0), ("0.9", 4.5), ("end", 5.0)):
        for suffix, x in (("", 0.0), ("-x0.7", 0.7), ("-x1.4", 1.4)):
            assert curves[f"depth-{place}{suffix}"] == [(x, y, z) for z in depths()]
