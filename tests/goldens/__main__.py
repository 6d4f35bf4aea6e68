"""Compute the goldens again and print the differences from the stored ones; `--write` stores them.

    python -m tests.goldens [--write] [CASE ...]

Exit code 0: nothing differs, or it is stored; 1: something differs.
"""

import argparse
import sys

from tests.goldens.answers import renewed, written
from tests.goldens.asked import CASES


def main() -> int:
    """Ask, print, and store where it is wanted; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument(
        "cases", nargs="*", metavar="CASE", choices=[[], *CASES], help="of these (default: all)"
    )
    parser.add_argument("--write", action="store_true", help="store the new answers")
    arguments = parser.parse_args()
    changed = 0
    for case in arguments.cases or CASES:
        answers, told = renewed(case)
        changed += len(told)
        print("\n".join([f"{case}: {len(told)} changes", *told]), flush=True)
        if arguments.write:
            written(case, answers)
    return int(changed > 0 and not arguments.write)


if __name__ == "__main__":
    sys.exit(main())
