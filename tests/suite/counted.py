"""Numbers that count the operations done with them."""

import math


class Counted:
    """A number whose sums, products, quotients, roots and angles are counted, one each; signs are free."""

    operations = 0

    def __init__(self, value):
        self.value = float(value)

    def __neg__(self):
        return Counted(-self.value)

    def __abs__(self):
        return Counted(abs(self.value))

    def __float__(self):
        return self.value

    def __lt__(self, other):
        return self.value < float(other)

    def __gt__(self, other):
        return self.value > float(other)

    def __eq__(self, other):
        return self.value == float(other)

    __hash__ = None

    def sqrt(self):
        """As numpy calls it."""
        Counted.operations += 1
        return Counted(math.sqrt(self.value))

    def rint(self):
        """As numpy calls it; not counted, as a comparison is not."""
        return Counted(round(self.value))

    def hypot(self, other):
        """A root, a sum and two products."""
        Counted.operations += 4
        return Counted(math.hypot(self.value, float(other)))

    def arctan2(self, other):
        """One operation, whatever it takes."""
        Counted.operations += 1
        return Counted(math.atan2(self.value, float(other)))


def _counting(name):
    def operate(self, other):
        if not isinstance(other, Counted | float | int):
            return NotImplemented
        Counted.operations += 1
        return Counted(getattr(self.value, name)(float(other)))

    return operate


for _name in ("add", "radd", "sub", "rsub", "mul", "rmul", "truediv", "rtruediv", "pow"):
    setattr(Counted, f"__{_name}__", _counting(f"__{_name}__"))
