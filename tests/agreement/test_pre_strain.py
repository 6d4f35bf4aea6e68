"""Pre-strain of curved strips means the same in both models: it is counted from the shape at rest."""

import numpy as np

from studies.answers.adapters import answer_static
from studies.answers.settings import FeSettings, Settings, SplineSettings
from studies.cases.design import read_design
from tests import gates
from tests.one_strip import SECOND_MOMENT, YOUNGS_MODULUS, one_strip

NATURAL_CURVATURE = 1.5

SCENE = f"""
effects = ["bending", "stretching", "pre_strain"]

[effects.pre_strain]
curvature_per_m = {NATURAL_CURVATURE}
"""
RIGIDITY = YOUNGS_MODULUS * SECOND_MOMENT


def left_over(folder, settings: Settings) -> tuple[float, float]:
    """Largest moment over EI kappa_n, and error of the tip's turn over kappa_n L: zero for a free arc."""
    path = folder / "arc.toml"
    path.write_text(one_strip(SCENE, rise=0.01))
    design = read_design(path)
    fields = answer_static(design, settings).along
    turn = NATURAL_CURVATURE * fields.arc_length[0, -1]
    moment = np.abs(fields.bending_moment[-1]).max() / (RIGIDITY * NATURAL_CURVATURE)
    return float(moment), float(abs(fields.rotation[-1, 0, -1] / turn - 1.0))


def test_free_arc_with_pre_strain_turns_by_it_without_stress(tmp_path):
    """Requirement: a free curved strip takes up its natural curvature beside the one at rest, stress-free."""

    def moment(control_points=8):
        return left_over(tmp_path, SplineSettings(control_points=control_points))[0]

    gates.hold("pre_strain_arc_spline", moment)
    # both are exact for the turn: to round-off of the free tip, and the elements for the moment as well
    for settings in (SplineSettings(control_points=12), FeSettings(elements=10)):
        assert max(left_over(tmp_path, settings)) < 1e-10
