"""What `make results` needs beyond the suite: without it stored results stay as they are."""

import shutil
import sys
from pathlib import Path

from studies.__main__ import main
from studies.cost.openseespy import _loaded
from studies.record.store import RESULTS

#: Studies that hold the suite against the other codes.
BESIDE_PEERS = ("cost/codes",)


def files_in(folder: Path) -> dict[str, bytes]:
    """Return the content of all files below a folder."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_results_stay_without_the_other_codes(tmp_path, monkeypatch, capsys):
    """Where Exudyn and OpenSees are not there, the studies beside them keep every byte, so that pages and
    report stay true, and each says in a line what to install."""
    for study in BESIDE_PEERS:
        shutil.copytree(RESULTS / "data" / study, tmp_path / "data" / study)
    before = files_in(tmp_path)
    _loaded.cache_clear()  # a code that was asked for before in this process is remembered
    for name in [loaded for loaded in sys.modules if loaded.partition(".")[0] in ("exudyn", "openseespy")]:
        monkeypatch.setitem(sys.modules, name, None)
    for name in ("exudyn", "openseespy"):
        monkeypatch.setitem(sys.modules, name, None)
    assert main(["run", *BESIDE_PEERS, "--results", str(tmp_path)]) == 0
    assert capsys.readouterr().err.splitlines() == [
        f"{study}: left as it is: it needs exudyn, openseespy: python -m pip install '.[peers]'"
        for study in BESIDE_PEERS
    ]
    assert files_in(tmp_path) == before
