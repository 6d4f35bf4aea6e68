"""What the account of a guide in solids rests on: strips of solids, a shell between clamps, a stage."""

import math

import pytest

from fe_reference import plate_factors
from studies.published import account, solids
from studies.published.solids import guide_compliance, linear_factor, solid_factor
from tests import gates

STRIP = {"width": 0.2, "thickness": 0.02}


def solid_error(cells=(24, 1, 2)):
    """Return how far a strip of solids without lateral strain is from a beam with shear."""
    known = 1.0 / (1.0 + 1.2 * 2.0 * STRIP["thickness"] ** 2)
    return abs(solid_factor(**STRIP, nu=0.0, cells=cells) / known - 1.0)


def shell_error(terms=solids.TERMS, monkeypatch=None):
    """Return how far the shell is from the plate where it is hardly bent."""
    monkeypatch.setattr(solids, "TERMS", tuple(terms))
    found = linear_factor(1e-3, **STRIP, nu=0.3)
    return abs(found - plate_factors(STRIP["width"], 0.3).linear)


def guide_error(cells=(40, 4)):
    """Return how far a guide with a rigid stage is from beams with shear that stretch, nu = 0."""
    slender, apart = 50.0, 0.6
    known = 1.0 + (1.2 * 2.0 + 1.0 / apart**2) / slender**2
    given = {"slenderness": slender, "apart": apart, "stage": 0.2, "stiffer": account.RIGID, "nu": 0.0}
    return abs(guide_compliance(**given, cells=cells) / known - 1.0)


def test_strip_of_solids():
    """Requirement: without lateral strain a strip of solids is a beam with shear."""
    gates.check("account_solid", solid_error())


@pytest.mark.slow
def test_thin_strips_of_solids_tend_to_plates():
    """Requirement: solids are softer than a plate with shear, the less so the thinner the strip is."""
    plate, gaps = plate_factors(STRIP["width"], 0.3).linear, []
    for thickness in (0.02, 0.01):
        with_shear = 1.0 / (1.0 / plate + 1.2 * 2.6 * thickness**2)
        found = solid_factor(STRIP["width"], thickness, nu=0.3, cells=(24, 1, 12))
        gaps.append(1.0 - found / with_shear)
    assert gaps[0] > 2.0 * gaps[1] > 0.0


@pytest.mark.slow
def test_shell_hardly_bent(monkeypatch):
    """Requirement: the shell between clamps is the plate where it is hardly bent."""
    gates.check("account_shell", shell_error(monkeypatch=monkeypatch))


def test_shell_flattens(monkeypatch):
    """Requirement: bent further a strip is stiffer, and never more than one that cannot curl."""
    monkeypatch.setattr(solids, "TERMS", (8, 2, 6))
    factors = [linear_factor(moment, **STRIP, nu=0.3) for moment in (0.1, 2.0, 8.0)]
    assert factors == sorted(factors)
    assert factors[-1] < 1.0 / (1.0 - 0.3**2)


def test_guide_with_a_rigid_stage():
    """Requirement: a guide in plane stress without lateral strain is two beams with shear that stretch."""
    gates.check("account_guide", guide_error())


@pytest.mark.slow
def test_gates_of_the_account_have_teeth(monkeypatch):
    """Requirement: coarser elements and fewer terms do not pass."""
    for gate, error in (
        ("account_solid", solid_error),
        ("account_guide", guide_error),
        ("account_shell", lambda **how: shell_error(monkeypatch=monkeypatch, **how)),
    ):
        with pytest.raises(AssertionError, match="x the gate"):
            gates.check(gate, error(**gates.teeth(gate)))


@pytest.mark.slow
def test_account_of_the_finest_solids():
    """Requirement: with all that is left out of it a beam is within 0.2 % of the solids, without it not."""
    rows = {row["answer"]: row for row in account.accounted(account.LOAD)["account"] if row["mesh_mm"] == 3.0}
    assert abs(rows[account.COMPLETE]["error"]) <= account.CLOSE
    assert all(
        abs(rows[name]["error"]) > account.CLOSE
        for name in (account.BEAM, account.CLAMPED_WIDTH, account.BOTH)
    )
    assert math.isclose(rows[account.BEAM]["published"], 48.6102e-3)
