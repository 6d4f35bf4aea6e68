"""The models that every family asks: the spline's default, the paper's own choices, and finite elements."""

from studies.answers.settings import FeSettings, Settings, SplineSettings

DEFAULT = "spline, default"
SIX = "spline n = 6"
PAPER = "spline n = 4, as the paper"
PRINTED = "spline n = 4, printed forces"
LOCKING_FREE = "spline n = 4, locking-free"
FE = "FE, 20 elements"

#: Column -> settings. A peer is a column of the families when its settings are answered by
#: `studies.answers.adapters`, as these are: add it here.
COLUMNS: dict[str, Settings] = {
    DEFAULT: SplineSettings(),
    LOCKING_FREE: SplineSettings(control_points=4),
    PAPER: SplineSettings(control_points=4, measure="spatial", stretch="consistent"),
    PRINTED: SplineSettings(control_points=4, measure="printed", stretch="consistent"),
    FE: FeSettings(),
}

#: Those of the families of paths, where the default takes as many control points as it needs: six beside it.
#: Motions, arcs of frames and starts from guesses take six by default.
PATHS: dict[str, Settings] = {**COLUMNS, SIX: SplineSettings(control_points=6)}

#: Finer splines, for families in which the default reaches its end.
EIGHT, TWELVE = "spline n = 8", "spline n = 12"
FINER: dict[str, Settings] = {
    EIGHT: SplineSettings(control_points=8),
    TWELVE: SplineSettings(control_points=12),
}

GENERALISED_ALPHA = "spline, generalised-alpha"
EXPLICIT = "spline, explicit"

#: All columns, in the order of tables and figures.
ORDER = (*PATHS, GENERALISED_ALPHA, EXPLICIT, *FINER)

#: Columns that show the paper's own choices: what this suite has an answer say of its resolution does not
#: count there, as the paper has no such check.
UNCHECKED = (PAPER, PRINTED)

#: A spline refined far beyond the default, with n + 2 Gauss points: what the others are held against.
REFINED = SplineSettings(control_points=14)
#: Another one, whose distance to it bounds what refinement still changes.
CHECK = SplineSettings(control_points=11)
#: An independent one.
INDEPENDENT = FeSettings(elements=40)
