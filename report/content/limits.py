"""What the suite does not show."""

from report.facts import Derived, Fact, fact
from report.forms import count, significant, unit
from report.gates import gates
from report.pick import largest, where
from report.results import Results
from studies.stability.columns import DEFAULT


def _unresolved(results: Results) -> int:
    table = where(results.table("stability/step_size", "outcomes"), model=DEFAULT)
    return int((table["outcome"] == "refused").sum())


FACTS: dict[str, Fact | Derived] = {
    "limits.stress": fact(
        "paper/fig05_stiffness",
        "summary",
        largest("max_stress_end_Pa", formulation="FE, 20 elements"),
        unit("GPa", 2, 1e-9),
    ),
    "limits.kept": fact(
        "baselines/peers",
        "swings_ratios",
        lambda t: t[(t["criterion"] == "and kept at finer steps") & t["ratio"].isna()]["level"].max(),
        unit("rad", 1),
    ),
    "limits.unresolved": Derived(made=_unresolved, form=count),
    "limits.gates": Derived(made=lambda _: len(gates()), form=count),
    "limits.designs": fact(
        "convergence/error_estimate", "estimates", lambda t: t["design"].nunique(), significant
    ),
}
