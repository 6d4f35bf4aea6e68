"""Solve thousands of designs: a grid, a list or a random sample over any keys of a case, into one table.

    python -m studies sweep studies/sweep/examples/design_space.toml --out designs
    python -m studies sweep studies/sweep/examples/four_bar.toml --out bars --csv
    python -m studies sweep DESIGNS.toml --out designs --scheduler tcp://HOST:8786

DESIGNS.toml says which designs, what is asked of each, and what is kept. All but case and [vary] may be
omitted:

    case = "cross_axis_pivot"         # comes with the suite, or a file beside this one: "my_pivot.toml"
    model = "spline"                  # spline, fe, fe-shear

    [settings]                        # of the model, as the options of `solve`
    control_points = 6

    [set]                             # keys of the case that all designs share
    drive.rotation_deg = 45

    [analysis]
    kind = "static"                   # static (default), modes, release
    # modes: rotation_deg, count, held; release: duration_s, step_s, integrator

    [sample]
    method = "sobol"                  # grid (default), list, sobol
    points = 4096                     # of sobol; `seed`, 0 if not given
    # chunk = 256                     # designs that are solved and kept at a time

    [vary]                            # SECTION.KEY as in the case, strips.NAME.KEY of a mechanism,
    strip.crossing_ratio = { from = 0.1, to = 0.9 }          # in a grid also `points`
    strip.slenderness = { from = 20, to = 100, scale = "log" }   # length over depth, at the case's width
    body.centre_offset_m.x = [0, 0.01]                       # a part of a pair; listed values
    settings.control_points = [4, 6, 8]                      # a setting

    [store]
    quantities = ["stiffness_rest_Nm_per_rad", "stress_max_Pa"]

Quantities that are usual: static: rotation, torque, stiffness at rest and at the end and its variation,
largest stress, energy, moment defect, iterations, and the shift of a pivot's crossing point or the places of
a mechanism's bodies; modes: frequencies; release: frequency, extremes, error of the energy. A wrong name
lists the others. A row a design: point, varied keys, status, reason, quantities; a design without an answer
keeps its row, with the reason.

The folder gets sweep.json (inputs, versions, columns), designs.parquet and, with --csv, designs.csv. A run
that was interrupted goes on when it is called again, and the table is the same, byte by byte; another
DESIGNS.toml asks for another folder. --scheduler hands the designs to the workers of a Dask cluster, where
the suite is installed as well (pip install ".[cluster]"); other processors may differ in round-off. Exit
code 0: done; 2: bad input, or a place that cannot be written to; 130: interrupted.
"""

import argparse
import sys

from studies.commands.arguments import OUT
from studies.commands.parser import Argument, command, whole_number

INTERRUPTED = 130


@command(
    Argument("designs DESIGNS.toml", "which designs, and what is asked of them"),
    OUT.but("folder of the table", required=True, metavar="DIR"),
    Argument("--csv", "write the table as CSV as well"),
    Argument("--workers N", "processes (default: all cores)", whole_number(1)),
    Argument("--scheduler ADDRESS", "of a Dask cluster, tcp://HOST:PORT (default: none, this machine alone)"),
)
def main(arguments: argparse.Namespace) -> int:
    """Run the missing part of a sweep; return the exit code. BadInput: --workers together with
    --scheduler."""
    from studies.errors import BadInput

    if arguments.scheduler is not None and arguments.workers:
        raise BadInput("--workers: got it with --scheduler, expected one of them: a cluster has its own")
    from studies.record.progress import Bar
    from studies.sweep.plan import read_plan
    from studies.sweep.run import cluster, local_pool, sweep

    plan = read_plan(arguments.designs)
    pool = cluster(arguments.scheduler) if arguments.scheduler is not None else local_pool(arguments.workers)
    try:
        with Bar("sweep") as bar:
            solved = sweep(plan, arguments.out, pool=pool, csv=arguments.csv, progress=bar)
    except KeyboardInterrupt:
        print(
            "studies: interrupted: the same command goes on with what is missing",
            file=sys.stderr,
        )
        return INTERRUPTED
    kept = plan.points - solved
    told = f"{solved} designs solved" + (f", {kept} were there" if kept else "")
    print(f"{told}: {arguments.out / 'designs.parquet'}")
    return 0
