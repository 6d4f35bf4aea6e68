"""Progress and timing report what happened and stay out of the way."""

import gc
import sys

import pytest

from studies.record import progress
from studies.record.progress import Bar, measure


def test_timing_warms_up_and_counts_repeats():
    """The work runs warm_up + repeat times; collection is off while timed and then restored."""
    seen = []
    timing = measure(lambda: seen.append(gc.isenabled()) or len(seen), repeat=3, warm_up=2)
    assert seen == [True, True, False, False, False]
    assert gc.isenabled()
    assert timing.result == 5
    assert len(timing.seconds) == 3
    assert min(timing.seconds) <= timing.median <= max(timing.seconds)
    with pytest.raises(ValueError, match="got 0, expected at least 1"):
        measure(lambda: None, repeat=0)


def test_bar_shows_long_work_on_a_terminal_only(capsys, monkeypatch):
    """Work that lasts is shown on the error stream where this is a terminal, short work is not."""
    for terminal, delay, shown in ((True, 60.0, False), (False, 0.0, False), (True, 0.0, True)):
        monkeypatch.setattr(sys.stderr, "isatty", lambda terminal=terminal: terminal)
        monkeypatch.setattr(progress, "DELAY", delay)
        with Bar("work") as bar:
            bar(1, 2)
            bar(2, 2)
        captured = capsys.readouterr()
        assert captured.out == ""
        assert ("work" in captured.err) is shown
