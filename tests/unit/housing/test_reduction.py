"""Reduction: exact statics, receptance within the bound, and what is refused."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from support.housing import seat_points, small_housing

from herringbone.core import HerringboneError, ParameterError
from herringbone.housing import write_housing
from herringbone.housing.files.validation import housing_warnings
from herringbone.housing.modal_model import SEAT_DOFS, ModalHousing
from herringbone.housing.reduction.bound import receptance_bound
from herringbone.housing.reduction.error import check_certificate, drive_point_errors
from herringbone.housing.reduction.reduce import reduce_model
from herringbone.housing.reduction.reduced_housing import (
    certified_bound,
    reduce_housing,
    with_residual_modes,
)

BAND = 2000.0


def bar(size: int) -> tuple[sp.csr_array, sp.csr_array, np.ndarray]:
    """A bar fixed at one end, first mode 100 Hz, next ones 200 Hz apart; 12 loaded stretches."""
    scale = 400.0 * size  # w_j = scale (j - 1/2) pi / size = 2 pi 100 (2 j - 1)
    diagonal = np.full(size, 2.0)
    diagonal[-1] = 1.0
    side = np.full(size - 1, -1.0)
    stiffness = scale**2 * sp.diags_array([side, diagonal, side], offsets=[-1, 0, 1])
    seats = np.zeros((size, 12))
    for k in range(12):
        width = max(size // 60, 1)
        start = (k + 1) * size // 13
        seats[start : start + width, k] = 1.0 / width
    return sp.csr_array(stiffness), sp.csr_array(sp.eye_array(size)), seats


@pytest.fixture(scope="module", params=[240, 1500], ids=["dense", "sparse"])
def model(request):
    return bar(request.param)


@pytest.fixture(scope="module")
def reduction(model):
    return reduce_model(*model, band_hz=BAND, tolerance=0.02)


def test_is_diagonal_and_mass_normalised(model, reduction):
    stiffness, mass, seats = model
    v, omega = reduction.vectors, 2 * np.pi * reduction.frequency_hz
    np.testing.assert_allclose(v.T @ (mass @ v), np.eye(omega.size), atol=1e-10)
    scaled = v / omega
    np.testing.assert_allclose(scaled.T @ (stiffness @ scaled), np.eye(omega.size), atol=1e-10)
    np.testing.assert_array_equal(reduction.seat_shapes, seats.T @ v)
    assert reduction.kind.count("residual") == 12


def test_statics_are_exact(model, reduction):
    stiffness, _, seats = model
    exact = seats.T @ np.linalg.solve(stiffness.toarray(), seats)
    scaled = reduction.seat_shapes / (2 * np.pi * reduction.frequency_hz)
    np.testing.assert_allclose(scaled @ scaled.T, exact, rtol=1e-10)
    np.testing.assert_allclose(reduction.static, exact, rtol=1e-10)


def undamped(shapes, frequency_hz, f):
    return (shapes / ((2 * np.pi * frequency_hz) ** 2 - (2 * np.pi * f) ** 2)) @ shapes.T


def test_receptance_within_the_bound(model, reduction):
    """All 144 entries, by direct solves, up to the band; and the bound is not idle."""
    stiffness, mass, seats = (m.toarray() if sp.issparse(m) else m for m in model)
    normal = np.array([kind == "normal" for kind in reduction.kind])
    kept = reduction.seat_shapes[:, normal] / (2 * np.pi * reduction.frequency_hz[normal])
    missing = np.diag(reduction.static) - (kept**2).sum(axis=1)
    following = reduction.certificate["next_frequency_hz"]
    worst = 0.0
    for f in np.linspace(20.0, BAND, 12):
        exact = seats.T @ np.linalg.solve(stiffness - (2 * np.pi * f) ** 2 * mass, seats)
        error = exact - undamped(reduction.seat_shapes, reduction.frequency_hz, f)
        bound = receptance_bound(missing, f, following)
        rounding = 1e-9 * np.abs(exact).max()
        assert (np.abs(error) <= np.sqrt(np.outer(bound, bound)) + rounding).all()
        if f > BAND / 2:  # well above rounding
            worst = max(worst, float((np.diag(error) / bound).max()))
    assert (bound / np.diag(reduction.static)).max() == pytest.approx(reduction.error_bound)
    assert 0.05 < worst <= 1.0
    assert reduction.error_bound <= 0.02


def test_modes_to_one_and_a_half_times_the_band(model):
    """Odd multiples of 100 Hz: 15 of them lie below 3 kHz, less the dispersion of the chain."""
    loose = reduce_model(*model, band_hz=BAND, tolerance=0.9)
    assert loose.certificate["normal_modes"] == 15
    assert loose.certificate["next_frequency_hz"] == pytest.approx(3100.0, rel=0.02)
    tight = reduce_model(*model, band_hz=BAND, tolerance=1e-3)
    assert tight.certificate["normal_modes"] > 15
    assert tight.error_bound <= 1e-3 < loose.error_bound


@pytest.mark.parametrize(("size", "most"), [(40, 64), (54, 64), (64, 64), (610, 620)])
def test_a_model_with_few_unknowns_is_kept_whole(size, most):
    """As many as are allowed, of which 12 need not be left for residual modes.

    Rounding grows with the condition of the stiffness, some size^2: 1e-10 for 610.
    """
    stiffness, mass, seats = bar(size)
    found = reduce_model(stiffness, mass, seats, band_hz=1e5, most_modes=most)
    assert found.kind == ("normal",) * size
    assert found.error_bound == 0.0
    exact = seats.T @ np.linalg.solve(stiffness.toarray(), seats)
    scaled = found.seat_shapes / (2 * np.pi * found.frequency_hz)
    np.testing.assert_allclose(scaled @ scaled.T, exact, rtol=1e-9)


def refused(**changes) -> str:
    stiffness, mass, seats = bar(240)
    given = {"stiffness": stiffness, "mass": mass, "seat_input": seats, "band_hz": BAND} | changes
    with pytest.raises(HerringboneError) as caught:
        reduce_model(**given)
    return str(caught.value)


def test_one_unknown_more_than_may_be_kept_is_refused():
    stiffness, mass, seats = bar(65)
    with pytest.raises(HerringboneError, match=r"52 modes, to \d+ Hz, do not certify 100000 Hz"):
        reduce_model(stiffness, mass, seats, band_hz=1e5)


def test_refusals():
    stiffness, mass, seats = bar(240)
    free = stiffness.tolil()
    free[0, 0] /= 2.0
    lopsided = stiffness.tolil()
    lopsided[3, 7] = 1e9
    assert "stiffness is (240, 240), mass (40, 40)" in refused(mass=bar(40)[1])
    assert "(n, 12)" in refused(seat_input=seats[:, :11])
    assert "must be held" in refused(stiffness=free.tocsr())
    assert "stiffness matrix is not symmetric" in refused(stiffness=lopsided.tocsr())
    assert "mass matrix has a negative diagonal" in refused(mass=-mass)
    assert "value that is not finite" in refused(mass=np.nan * mass)
    assert "empty column" in refused(seat_input=0.0 * seats)
    indefinite = mass.tolil()
    indefinite[3, 7] = indefinite[7, 3] = 2.0
    assert "mass matrix is not positive definite" in refused(mass=indefinite.tocsr())
    for most in (11, 1, 0):
        assert f"most_modes = {most}: the 12 seat directions" in refused(most_modes=most)
    text = refused(band_hz=9000.0, most_modes=40)
    assert "28 modes, to 5655 Hz, do not certify 9000 Hz within 0.05" in text


@pytest.mark.parametrize("size", [240, 1500])
@pytest.mark.parametrize("light", [0.0, 1e-320])
def test_unknowns_without_mass_are_as_if_condensed(size, light):
    """Two springs in a row, however many unknowns there are; rounding as of kept models."""
    stiffness, mass, seats = bar(size)
    massless = mass.tolil()
    massless[5, 5] = light
    keep = np.delete(np.arange(size), 5)
    column = stiffness[keep][:, [5]]
    condensed = stiffness[keep][:, keep] - column @ column.T / stiffness[5, 5]
    found = reduce_model(stiffness, massless.tocsr(), seats, band_hz=BAND)
    expected = reduce_model(condensed.tocsr(), mass[keep][:, keep], seats[keep], band_hz=BAND)
    np.testing.assert_allclose(found.frequency_hz, expected.frequency_hz, rtol=1e-9)
    np.testing.assert_allclose(found.static, expected.static, rtol=1e-9)
    assert found.error_bound == pytest.approx(expected.error_bound, rel=1e-6)


def test_too_few_unknowns_with_mass():
    stiffness, mass, seats = bar(40)
    massless = mass.tolil()
    massless[1, 1] = 0.0
    with pytest.raises(HerringboneError, match="40 unknowns have 39 modes with mass, too few"):
        reduce_model(stiffness, massless.tocsr(), seats, band_hz=1e5)


def as_housing(found, valid_to_hz: float) -> ModalHousing:
    return ModalHousing(
        found.kind,
        found.frequency_hz,
        np.full(found.frequency_hz.size, 0.01),
        seat_points(),
        found.seat_shapes,
        valid_to_hz,
        {"model": "viscous-modal", "source": "assumed"},
        static=found.static,
        gram=found.vectors.T @ found.vectors,
        certificate=found.certificate,
    )


def test_reducing_twice_is_reducing_once():
    """The data hold the static response, so the residual vectors are those of the full model."""
    model = bar(240)
    full = as_housing(reduce_model(*model, band_hz=BAND, tolerance=0.01), BAND)
    twice = reduce_housing(full, band_hz=800.0, tolerance=0.2)
    once = reduce_model(*model, band_hz=800.0, tolerance=twice.certificate["tolerance"])
    assert twice.certificate["normal_modes"] == once.certificate["normal_modes"] == 6
    assert twice.valid_to_hz == 800.0
    # Residual Ritz values of second order in vectors that agree to 1e-10 or so.
    np.testing.assert_allclose(twice.frequency_hz, once.frequency_hz, rtol=1e-6)
    np.testing.assert_allclose(twice.static_compliance(), once.static, rtol=1e-10)
    np.testing.assert_allclose(np.diag(twice.gram), 1.0, rtol=1e-8)
    assert set(twice.damping_ratio[6:]) == {0.05}


def test_certificate_at_a_lower_band():
    """The bound grows as r^4 / (1 - r^2): at half the band it is that of the same model there."""
    full = as_housing(reduce_model(*bar(240), band_hz=BAND, tolerance=0.05), BAND)
    r = BAND / full.certificate["next_frequency_hz"]
    expected = full.certificate["error_bound"] / 16 * (1 - r**2) / (1 - r**2 / 4)
    assert certified_bound(full, BAND / 2) == pytest.approx(expected, rel=1e-12)
    assert certified_bound(full, BAND) == full.certificate["error_bound"]
    assert certified_bound(replace(full, certificate={}), BAND) == 0.0
    assert certified_bound(replace(full, certificate={"error_bound": None}), BAND) == 0.0


def test_nothing_is_dropped_if_all_is_needed():
    full = as_housing(reduce_model(*bar(240), band_hz=BAND, tolerance=0.05), BAND)
    same = reduce_housing(full, band_hz=BAND, tolerance=0.051)
    assert same.certificate["error_bound"] == full.certificate["error_bound"]
    np.testing.assert_array_equal(same.shapes, full.shapes)


def test_requests_beyond_the_data():
    full = as_housing(reduce_model(*bar(240), band_hz=BAND, tolerance=0.05), BAND)
    for band, tolerance, expected in (
        (2500.0, 0.05, "band 2500 Hz is beyond valid_to_hz = 2000 Hz"),
        (-1.0, 0.05, "band -1 Hz must be positive"),
        (1000.0, 1.5, "tolerance 1.5 must lie between 0 and 1"),
        (1000.0, 1e-9, "the data themselves are certified to"),
    ):
        with pytest.raises(ParameterError, match=expected):
            reduce_housing(full, band_hz=band, tolerance=tolerance)


def test_residual_matrix_becomes_pseudo_modes():
    """Statics exact; the error at f is R r^2 / (1 - r^2), as for any oscillator at f_r."""
    housing = small_housing()
    found = with_residual_modes(housing, frequency_hz=8000.0)
    expected = housing.static_compliance() + housing.residual
    np.testing.assert_allclose(found.static_compliance(), expected, rtol=1e-10, atol=1e-22)
    undamped_ones = replace(found, damping_ratio=0.0 * found.damping_ratio)
    without = replace(housing, damping_ratio=0.0 * housing.damping_ratio)
    f = np.array([2000.0])
    error = (undamped_ones.receptance(f) - without.receptance(f))[0].real - housing.residual
    np.testing.assert_allclose(error, housing.residual / 15.0, rtol=1e-8, atol=1e-22)
    assert found.residual is None
    assert found.gram.shape == (32, 32)
    assert not found.shape("A", "z")[20:].any()


def test_residual_matrix_without_normal_modes():
    """Pseudo modes at twice 1.5 times the band of 2 kHz; nothing is left that may be dropped."""
    housing = small_housing(kind=("residual",) * 20, static=None, certificate={})
    found = reduce_housing(housing, band_hz=600.0, tolerance=0.05)
    assert set(found.frequency_hz[20:]) == {6000.0}
    assert found.frequency_hz.size == 32
    expected = housing.static_compliance() + housing.residual
    np.testing.assert_allclose(found.static_compliance(), expected, rtol=1e-9, atol=1e-20)


def test_rigid_body_modes_alone():
    rigid = small_housing(kind=("rigid",) * 20, frequency_hz=np.zeros(20), residual=None)
    with pytest.raises(ParameterError, match="have rigid-body modes only; there is nothing to red"):
        reduce_housing(rigid, band_hz=600.0, tolerance=0.05)


def test_a_seat_that_does_not_move_along_an_axis():
    """Its error over its compliance is 0 / 0, which no tolerance excludes."""
    full = as_housing(reduce_model(*bar(240), band_hz=BAND, tolerance=0.05), BAND)
    shapes = full.shapes.copy()
    shapes[SEAT_DOFS.index(("wheel_left", "x"))] = 0.0
    told = "^seat wheel_left does not move along x in any oscillator"
    with pytest.raises(ParameterError, match=told):
        reduce_housing(replace(full, shapes=shapes), band_hz=1000.0, tolerance=0.2)


def test_residual_matrix_is_reduced_and_written(tmp_path):
    housing = small_housing(static=None)
    found = reduce_housing(housing, band_hz=600.0, tolerance=0.05)
    expected = housing.static_compliance() + housing.residual
    np.testing.assert_allclose(found.static_compliance(), expected, rtol=1e-9, atol=1e-20)
    assert write_housing(found, tmp_path / "reduced") == []
    assert housing_warnings(found) == []


def test_residual_oscillators_below_the_next_mode_are_kept():
    """The bound holds only if all that is dropped lies above; three are amid the normal modes."""
    frequency_hz = np.concatenate([np.linspace(300.0, 9000.0, 37), [700.0, 720.0, 740.0]])
    shapes = 0.1 * np.random.default_rng(5).standard_normal((13, 40))
    full = small_housing(
        40, kind=("normal",) * 37 + ("residual",) * 3, frequency_hz=frequency_hz, shapes=shapes,
        static=None, residual=None, gram=None, certificate={},
    )  # fmt: skip
    found = reduce_housing(full, band_hz=1000.0, tolerance=0.05)
    errors = drive_point_errors(full, found, np.linspace(1.0, 1000.0, 500))
    certificate = found.certificate
    assert 0.0 < errors.max() <= certificate["error_bound"] <= 0.05
    below = full.frequency_hz < certificate["next_frequency_hz"]
    assert set(full.frequency_hz[below]) <= set(found.frequency_hz)
    assert certificate["normal_modes"] == found.kind.count("normal") == below.sum() - 3


def test_a_disproved_certificate_is_refused():
    found = small_housing(certificate={"error_bound": 0.045})
    with pytest.raises(HerringboneError, match=r"to 1000 Hz is 24433 %, above the 4\.5 % that"):
        check_certificate(found, 1000.0, 244.33)
    check_certificate(found, 1000.0, 0.045 + 1e-12)


def test_negative_residual():
    housing = small_housing(residual=np.diag([1e-10] * 11 + [-1e-10]))
    with pytest.raises(HerringboneError, match="negative eigenvalue -1e-10 m/N"):
        with_residual_modes(housing)
