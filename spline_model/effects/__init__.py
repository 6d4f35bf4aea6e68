"""Effects: the named frozen values a scene is made of."""

from spline_model.effects.base import BodyDamper as BodyDamper
from spline_model.effects.base import BodyInertia as BodyInertia
from spline_model.effects.base import Gravity as Gravity
from spline_model.effects.base import SectionRotaryInertia as SectionRotaryInertia
from spline_model.effects.base import StripDamping as StripDamping
from spline_model.effects.base import StripDrag as StripDrag
from spline_model.effects.base import StripInertia as StripInertia
from spline_model.effects.boundary import ALWAYS as ALWAYS
from spline_model.effects.boundary import GROUND as GROUND
from spline_model.effects.boundary import AppliedLoad as AppliedLoad
from spline_model.effects.boundary import Clamp as Clamp
from spline_model.effects.boundary import Driven as Driven
from spline_model.effects.boundary import DrivenDisplacement as DrivenDisplacement
from spline_model.effects.boundary import DrivenRotation as DrivenRotation
from spline_model.effects.boundary import Spring as Spring
from spline_model.effects.elastic import MEASURES as MEASURES
from spline_model.effects.elastic import Bending as Bending
from spline_model.effects.elastic import MixedStretching as MixedStretching
from spline_model.effects.elastic import StrainEnergy as StrainEnergy
from spline_model.effects.elastic import Stretching as Stretching
