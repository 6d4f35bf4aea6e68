"""Any mechanism of flexures: strips, bodies and named effects as a scene."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, lru_cache
from typing import Any, Literal, Self, Unpack

import numpy as np

from spline_model.compile import System, compile_scene
from spline_model.design import HINGE, LARGEST_OPENING, BodyDesign, Design, StripDesign
from spline_model.discretisation import Described, Discretisation, motion_penalty_stiffness
from spline_model.effects import AppliedLoad, Clamp, Driven, DrivenRotation
from spline_model.effects.base import Inertia
from spline_model.effects.elastic import CURLING
from spline_model.effects.registry import (
    DEFAULT_EFFECTS,
    INERTIA,
    ROOTS,
    Parameters,
    build,
    check_names,
    root_length,
)
from spline_model.errors import InvalidParameter, require_kind
from spline_model.reduced.model import reduced
from spline_model.rigid import loose, props_of
from spline_model.scene import Body, Effect, Scene, Strip


@dataclass(frozen=True, kw_only=True, eq=False)
class Mechanism:
    """A design, the names of its effects with their parameters, and its scene without a driven rotation.

    ``compliant_mechanism`` and ``spline_model.pivot.cross_axis_pivot`` return one. All values are in SI
    units. placing: the keywords of ``cross_axis_pivot`` that place its strips [m, rad, 1], empty of another
    mechanism.

    Examples
    --------
    With ``pivot`` of the example of ``spline_model.pivot.cross_axis_pivot``:

    >>> isinstance(pivot, Mechanism), pivot.effects
    (True, ('bending', 'stretching', 'strip_inertia', 'body_inertia'))
    """

    design: Design
    effects: tuple[str, ...]
    parameters: Parameters
    scene: Scene
    placing: Mapping[str, float] = field(default_factory=dict)

    def with_discretisation(self, **changes: Any) -> Self:
        """Return the same mechanism with other keywords of ``Discretisation``; InvalidParameter as of this
        class."""
        grid = self.design.discretisation
        made = compliant_mechanism(
            strips=self.design.strips,
            bodies=self.design.bodies,
            effects=self.effects,
            parameters=self.parameters,
            **({each.name: getattr(grid, each.name) for each in fields(grid)} | changes),
        )
        return replace(self, design=made.design, effects=made.effects, scene=made.scene)

    def on(self, segments: int, control_points: int) -> Self:
        """Return the same mechanism with this number of segments per strip and of control points per segment.

        Axial modes and Gauss points then have their defaults.
        """
        grid = self.design.discretisation
        asked = segments, control_points
        if asked == (grid.segments, grid.control_points):
            return self
        if asked not in self._refined:
            own = {} if asked == (grid.segments, grid.points) else {"axial_modes": None, "gauss_points": None}
            self._refined[asked] = self.with_discretisation(
                segments=segments, control_points=control_points, **own
            )
        return self._refined[asked]

    @cached_property
    def _refined(self) -> dict[tuple[int, int], Self]:
        """The mechanism on other discretisations, each made once."""
        return {}

    def in_motion(self) -> Self:
        """Return the mechanism for motions: with ``motion_penalty_stiffness`` if no penalty stiffness was
        given.

        Motions and modes, and the static states that they begin from, use this mechanism, whose number of
        control points is fixed. It is computed once.
        """
        return self._swinging

    @cached_property
    def _swinging(self) -> Self:
        grid = self.design.discretisation
        if None not in (grid.penalty_stiffness, grid.control_points):
            return self
        stiffness = motion_penalty_stiffness(grid.points) if grid.penalty_stiffness is None else grid.slide
        return self.with_discretisation(control_points=grid.points, penalty_stiffness=stiffness)

    def driven(self, rotation: float, body: str | None = None) -> Scene:
        """Return the scene with a body's rotation driven to ``rotation`` [rad] at load factor 1 (Eq 7)."""
        drive = DrivenRotation(body=self.design.body_named(body), angle=rotation)
        shared = self.scene.structure.setdefault(("driven", drive.body), {})
        return self.scene.with_effects(drive).sharing(shared)

    def system(self, rotation: float | None = None, body: str | None = None) -> System:
        """Return the system of the scene, with a body's ``rotation`` [rad] driven where one is given.

        All that does not depend on the rotation is made once.
        """
        name = None if rotation is None else self.design.body_named(body)
        if name not in self._systems:
            scene = self.scene if rotation is None else self.driven(rotation, name)
            self._systems[name] = compile_scene(scene)
            reduced(self._systems[name])
        system = self._systems[name]
        return system if rotation is None else system.turned_to(rotation)

    @cached_property
    def _systems(self) -> dict[str | None, System]:
        return {}

    def propped(self, turned: bool = False, body: str | None = None) -> Self:
        """Return the mechanism with props against free rigid motions; `turned`: beside a driven rotation."""
        if not self._is_loose:
            return self
        drives = [DrivenRotation(body=self.design.body_named(body), angle=0.0)] if turned else []
        scene = self.scene
        return replace(self, scene=scene.with_effects(*props_of(scene.with_effects(*drives))))

    @cached_property
    def _is_loose(self) -> bool:
        shared = self.scene.structure
        if "loose" not in shared:
            shared["loose"] = bool(loose(self.scene))
        return bool(shared["loose"])

    def released(self) -> Scene:
        """Return the scene in motion (``in_motion``), without the drives that only hold the start.

        Raises
        ------
        InvalidParameter
            No effect has inertia, or the forces are the published ones, which have no energy.
        """
        if not self.scene.of(Inertia):
            raise InvalidParameter("effects", list(self.effects), f"one of {', '.join(INERTIA)} for a motion")
        if self.design.discretisation.measure == "published":
            expected = "material or spatial for motions and modes: published forces are for static paths only"
            raise InvalidParameter("measure", "published", expected)
        scene = self.in_motion().scene
        kept = (e for e in scene.effects if not (isinstance(e, Driven) and e.lets_go))
        return replace(scene, effects=tuple(kept))

    def at_start(self) -> Self:
        """Return the mechanism with loads and drives at their values at the start of a motion."""
        effects = (e.at(0.0) if isinstance(e, AppliedLoad | Driven) else e for e in self.scene.effects)
        return replace(self, scene=replace(self.scene, effects=tuple(effects)))


def compliant_mechanism(
    *,
    strips: Sequence[StripDesign],
    bodies: Sequence[BodyDesign] = (),
    effects: Sequence[str] = DEFAULT_EFFECTS,
    parameters: Parameters | None = None,
    **described: Unpack[Described],
) -> Mechanism:
    """Return a mechanism of strips and rigid bodies whose scene contains the named effects only.

    Parameters
    ----------
    strips : sequence of StripDesign
        Strips between ground and bodies; a strip may end free.
    bodies : sequence of BodyDesign, default ()
        Rigid bodies.
    effects : sequence of str
        Names of ``spline_model.effects.registry``. `stretch="inextensible"` and the effect "inextensible"
        are the same.
    parameters : mapping, SI units, default None
        Parameters of each named effect, by effect, or a sequence of them for an effect that acts several
        times.
    described
        Keywords of ``spline_model.discretisation.Discretisation``. Strips are cut into more segments than
        these say where a segment would be an arc of more than LARGEST_OPENING.

    Returns
    -------
    Mechanism

    Raises
    ------
    InvalidParameter
        A value outside its range, an unknown body, or effects that contradict each other.

    References
    ----------
    Valentini and Pezzuti (2013), Eqs 2 to 10, for one strip.

    Examples
    --------
    >>> strip = StripDesign(
    ...     name="strip", start=(0.0, 0.0), end=(0.1, 0.0), root="ground", tip="tip",
    ...     width=0.01, thickness=1e-3,
    ...     youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0,
    ... )
    >>> tip = BodyDesign(name="tip", centre=(0.1, 0.0), mass=0.05, moment_of_inertia=1e-5)
    >>> mechanism = compliant_mechanism(strips=[strip], bodies=[tip], control_points=6)
    """
    grid = Discretisation.described(**described)
    arcs = (2.0 * abs(strip.opening) for strip in strips if strip.rise)
    fewest = max((math.ceil(arc / LARGEST_OPENING) for arc in arcs), default=1)
    if fewest > grid.segments:
        grid = replace(grid, segments=fewest)
    given = dict(parameters or {})
    names = tuple(effects)
    if grid.stretch == "inextensible":
        names = tuple("inextensible" if name == "stretching" else name for name in names)
    check_names(names, given)
    if "inextensible" in names and grid.stretch == "consistent":
        raise InvalidParameter("stretch", "consistent", "mixed for inextensible strips")
    single = {name: each for name, each in given.items() if isinstance(each, Mapping)}
    pre_strain = dict(single.get("pre_strain", {}))
    design = Design(
        strips=tuple(strips),
        bodies=tuple(bodies),
        discretisation=grid,
        pre_strain=pre_strain,
        curling=tuple(name for name in names if name in CURLING),
        root_length=root_length(**single.get(ROOTS, {})) if ROOTS in names else 0.0,
    )
    built = build(names, given, design)
    frames = {each.name: each for each in built if isinstance(each, Body)}
    ends: tuple[Literal["start", "end"], ...] = ("start", "end")
    clamps: list[Effect] = []
    for strip, whole, _ in design.pieces:
        for end in ends:
            clamps += _joined(strip, whole, end, frames)
    scene = Scene(
        strips=tuple(
            Strip(
                name=piece.name,
                basis=grid.spline,
                control_points=piece.control_points(grid.spline),
                of=whole.name,
                taper=piece.taper,
                linear_density=piece.linear_density,
                rotary_density=piece.density * piece.second_moment_of_area,
            )
            for piece, whole, _ in design.pieces
        ),
        bodies=(
            *(
                Body(**vars(body) | {"centre": np.asarray(body.centre, dtype=float), "joint": joint})
                for joint, own in ((False, bodies), (True, design.joints))
                for body in own
            ),
            *frames.values(),
        ),
        effects=(*(each for each in built if not isinstance(each, Body)), *clamps),
    )
    if not given:
        joined = tuple((s.name, s.root, s.tip, s.root_joint, s.tip_joint) for s in strips)
        scene.sharing(_structure(joined, tuple(body.name for body in bodies), names, grid))
    return Mechanism(design=design, effects=names, parameters=given, scene=scene)


@lru_cache(maxsize=256)
def _structure(*of: Any) -> dict[Any, Any]:
    """The ``Scene.structure`` of all mechanisms without parameters whose strips, bodies, effects and
    discretisation are these."""
    return {}


def _joined(
    strip: StripDesign, whole: StripDesign, end: Literal["start", "end"], frames: dict[str, Body]
) -> list[Clamp]:
    """The clamp of an end of a piece of a whole strip, if it has one; a hinge's frame joins the frames."""
    root = end == "start"
    to, joint = (strip.root, strip.root_joint) if root else (strip.tip, strip.tip_joint)
    if to is not None and joint != HINGE:
        return [Clamp(strip=strip.name, end=end, to=to)]
    word, place = ("root", strip.start) if root else ("tip", strip.end)
    frame = f"{word} of {whole.name}"
    if joint == HINGE:
        frames[frame] = Body(name=frame, centre=np.array(place, dtype=float), joint=True, on=to)
        return [Clamp(strip=strip.name, end=end, to=frame)]
    return [Clamp(strip=strip.name, end=end, to=frame, free=True)] if frame in frames else []


def require_mechanism(value: Any) -> None:
    """Raise InvalidParameter if `value` is no mechanism of this package, such as a finite-element model."""
    made = "what cross_axis_pivot or compliant_mechanism of spline_model returns"
    require_kind("mechanism", value, Mechanism, made)
