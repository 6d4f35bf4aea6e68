"""The server on a real port, without a browser."""

import math

import pytest

pytest.importorskip("cv2", reason="the extra `interactive` is not installed")
pytest.importorskip("uvicorn", reason="the extra `interactive` is not installed")

from studies.cases.problem import named_case
from studies.errors import BadInput
from studies.interactive.session import Session, replay
from studies.interactive.web import protocol
from studies.interactive.web.server import Server, Settings
from tests.interactive.sockets import answer, opened, say, told


def test_bad_numbers_are_answered_and_change_nothing(server):
    """Requirement: an event with a number out of range is answered by an error; the socket lives on."""
    with opened(server) as socket:
        say(socket, do="parameter", name="length", value=70.0)
        assert "length: got 70000, expected 0.01 to 10000 mm" in answer(socket, "error")["text"]
        assert told(socket, do="pose", pose=[0, 0, 0.2])["pose"][2] == pytest.approx(0.2)


def test_failing_solver_keeps_the_last_state(server, monkeypatch):
    """Requirement: an arithmetic fault of the solver, or a number that is not finite, is answered by a
    sentence; the next event is answered as ever."""
    with opened(server) as socket:
        told(socket, do="pose", pose=[0, 0, 0.2])
        for fault in (lambda *_: 1 / 0, lambda *_: {"pose": [math.nan]}):
            with monkeypatch.context() as patch:
                patch.setattr(Session, "feed", fault)
                say(socket, do="pose", pose=[0, 0, 0.3])
                text = answer(socket, "error")["text"]
                assert text.startswith("The solver failed, the last good state is kept")
        assert told(socket, do="tick")["pose"][2] == pytest.approx(0.2)


def test_released_body_runs_by_itself(server):
    """Requirement: without pictures the server drives a released body on at 25 Hz until it is paused."""
    with opened(server) as socket:
        say(socket, do="drive", by="rotation")
        say(socket, do="pose", pose=[0, 0, 0.6])
        say(socket, do="release")
        steps = [answer(socket)["steps"] for _ in range(12)]
        assert steps[-1] > 15
        say(socket, do="pause")
        while not answer(socket)["paused"]:
            pass


def test_design_is_saved_and_opened(server, tmp_path):
    """Requirement: the design is a case file that the commands read; opened, it is the same design; a text
    that is no case is named in one line."""
    with opened(server) as socket:
        values = told(socket, do="parameter", name="thickness", value=7e-4)["values"]
        say(socket, do="save")
        text = answer(socket, "case")["text"]
        (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
        problem = named_case(tmp_path / "mine.toml")
        assert (problem.width, problem.thickness) == pytest.approx((0.01, 7e-4))
        assert problem.effects.parameters()["strip_damping"] == {"relaxation_time": 2e-3}
        told(socket, do="preset", name="table-1")
        socket.send(protocol.DESIGN + text.encode())
        state = answer(socket)
        same = {**state["values"], "time_scale": values["time_scale"]}
        assert same == pytest.approx(values | {"yield_strength": 30e6})
        assert state["preset"] == "own"
        for wrong in (text.replace("length_m", "lenght_m"), "no = case = file"):
            socket.send(protocol.DESIGN + wrong.encode())
            assert "design.toml: " in answer(socket, "error")["text"]


def test_curve_of_every_design_is_sent(server):
    """Requirement: with each design comes its moment over rotation and where it yields, as held states do."""
    with opened(server) as socket:
        say(socket, do="parameter", name="thickness", value=2e-3)
        assert answer(socket, "curve")["text"].startswith("does not yield up to ")
        curve = answer(socket, "curve")
        told(socket, do="drive", by="rotation")
        at, moment = curve["yields"]
        states = []
        for angle in (curve["rotation"][6], 0.99 * at, 1.01 * at):
            states.append(told(socket, do="pose", pose=[0, 0, angle]))
        assert states[0]["force"][2] == pytest.approx(curve["moment"][6], rel=1e-9)
        assert states[1]["force"][2] < moment < states[2]["force"][2]
        assert states[1]["stress"]["of_yield"] < 1.0 < states[2]["stress"]["of_yield"]
        assert curve["text"].startswith(f"yields at ±{math.degrees(at):.1f}° by ")


def test_record_file_replays():
    """Requirement: what `--record` stores of the first page replays to the same states."""
    lines = []
    with Server(Settings(camera="none", keep=lines.append)) as hosted, opened(hosted) as socket:
        with opened(hosted) as second:
            told(second, do="pose", pose=[0, 0, 0.3])
        for k in range(5):
            told(socket, do="pose", pose=[0, 0, 0.1 * k])
    same = [good for _, good in replay(lines)]
    assert len(same) == 7
    assert all(same)


def test_taken_port_is_one_line(server):
    """Requirement: a port that is taken is refused in one line."""
    with pytest.raises(BadInput, match=rf"--port: got {server.port}, expected a free one"):
        Server(Settings(port=server.port)).bind()
