"""Independent finite-element reference for flexural pivots: thin strips and rigid bodies, on scikit-fem.

Data flow one way, and so do the imports:

    read -> strip, effects -> model; law, places, loads -> actions; these, matrix -> structure (with the mesh)
    structure -> control (with Newton's method) -> response (with critical points) -> path -> statics
    structure -> mass -> motion (with its drives) -> schemes -> dynamics
    statics -> modes; all -> solution -> refined (meshes to a wanted accuracy) -> statics, modes
    plate: one strip as a plate, the stiffness that beam theory neglects, and its rigidity -> structure

What is scikit-fem's, and what is not: the mesh of the strips, the basis of three linear fields on it, the
numbering of its degrees of freedom and the pattern of the assembled matrices are scikit-fem's. The energies
of the two elements, their forces and tangents (`law`), the elimination of the ends on bodies, the sums into
the kept pattern and the factors (`matrix`) are this package's, compiled. The same energies written as weak
forms, integrated and assembled by scikit-fem, give the same energy, forces and tangent to round-off far from
rest; a test holds both elements to that.
"""

from .dynamics import solve_motion
from .effects import DEFAULT_EFFECTS, DrivenRotation
from .model import ELEMENTS, BodyDesign, Model, compliant_mechanism, cross_axis_pivot
from .modes import Modes, natural_frequencies
from .motion import Trajectory
from .plate import PlateFactors, plate_factors
from .read import ConvergenceError, InvalidParameter
from .response import CriticalPoint
from .solid import SolidPath, SolidStrip, solve_solids
from .solution import ErrorEstimate, StaticSolution, Status, StripFields, strip_fields
from .statics import solve_statics
from .strip import StripDesign

__all__ = [
    "DEFAULT_EFFECTS",
    "ELEMENTS",
    "BodyDesign",
    "ConvergenceError",
    "CriticalPoint",
    "DrivenRotation",
    "ErrorEstimate",
    "InvalidParameter",
    "Model",
    "Modes",
    "PlateFactors",
    "SolidPath",
    "SolidStrip",
    "StaticSolution",
    "Status",
    "StripDesign",
    "StripFields",
    "Trajectory",
    "compliant_mechanism",
    "cross_axis_pivot",
    "natural_frequencies",
    "plate_factors",
    "solve_motion",
    "solve_solids",
    "solve_statics",
    "strip_fields",
]
