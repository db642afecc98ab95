"""Answers as objects with types: attributes for people and type checkers, and the JSON of the command as a mapping."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from types import UnionType
from typing import Any, Literal, Self, get_args, get_origin, get_type_hints


class Record(Mapping[str, Any]):
    """What the command answers: its JSON as a mapping, and the same as attributes, of which a missing one is None."""

    json: dict[str, Any]
    """The JSON, as the schema describes it."""

    @classmethod
    def of(cls, answer: Mapping[str, Any]) -> Self:
        """From the JSON."""
        hints = get_type_hints(cls)
        made = cls(**{own.name: _read(hints[own.name], answer.get(own.name)) for own in fields(cls)})  # type: ignore[arg-type]
        object.__setattr__(made, "json", dict(answer))
        return made

    def __getitem__(self, name: str) -> Any:
        return self.json[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.json)

    def __len__(self) -> int:
        return len(self.json)

    def __repr__(self) -> str:
        shown = ", ".join(f"{own.name}={_short(getattr(self, own.name))}" for own in fields(self))  # type: ignore[arg-type]
        return f"<deltaq.{type(self).__name__} {shown}>"


def _read(hint: Any, value: Any) -> Any:
    """What stands for `hint` in JSON; None where another thing stands there, such as the reason why there is no answer."""
    if get_origin(hint) is UnionType:
        [hint] = [own for own in get_args(hint) if own is not type(None)]
    if get_origin(hint) is tuple:
        return tuple(_read(get_args(hint)[0], own) for own in value) if isinstance(value, list) else None
    if isinstance(hint, type) and issubclass(hint, Record):
        return hint.of(value) if isinstance(value, dict) else None
    if get_origin(hint) is dict:
        return value if value is None else {own["name"]: own["value"] for own in value}
    return value


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:56]} ..."


@dataclass(frozen=True, eq=False, repr=False)
class InvariantMeasure(Record):
    """Whether there is an invariant measure exp(sigma(q)) dq dp, smooth and positive near almost every point."""

    answer: Literal["none", "local", "open"]
    """"none", "local" (near almost every point) or "open"."""
    proved: bool | None
    """Whether "none" and `none_free_of` are proved; else they are computed by ranks."""
    none_free_of: tuple[str, ...] | None
    """Cyclic coordinates, if every density depends on one of them."""
    density: str | None
    """The density in the names of the system; None if it is not printed."""
    reason: str | None
    """Why the question is open."""


@dataclass(frozen=True, eq=False, repr=False)
class TimeChange(Record):
    """Whether dtau = f dt makes the motion over some of the coordinates a Hamiltonian one."""

    over: tuple[str, ...]
    """These coordinates."""
    answer: Literal["none", "local"]
    """"none" (proved) or "local"."""
    factor: str | None
    """f in the names of the system; None if it is not printed."""


@dataclass(frozen=True, eq=False, repr=False)
class PolynomialIntegrals(Record):
    """First integrals that are polynomials of one degree in the velocities."""

    degree: int
    """The degree."""
    answer: Literal["none", "local", "open"]
    """"none" (only the trivial ones, proved), "local" or "open"."""
    at_most: int | None
    """Upper bound of their number, proved."""
    trivial: int | None
    """How many of them the energy, constants and products of lower ones make."""
    order: int | None
    """Weight of the Taylor coefficients that were used."""
    reason: str | None
    """Why the question is open."""


@dataclass(frozen=True, eq=False, repr=False)
class PrintedIntegral(Record):
    """A first integral as a formula."""

    kind: Literal["energy", "moving energy", "integral"]
    """What it is."""
    degree: int
    """Degree in the velocities."""
    expression: str
    """The formula."""
    drift: float | None
    """Largest change along the motion, relative to the sum of its terms without signs."""
    no_motion: str | None
    """Why there is no motion to try it on."""


@dataclass(frozen=True, eq=False, repr=False)
class Ansatz(Record):
    """First integrals among combinations of some functions."""

    functions: int | None
    """Number of functions that are independent on the constraints."""
    coordinates: tuple[str, ...] | None
    """Coordinates that they contain."""
    spatial_degree: int | None
    """Their degree in these."""
    dimension: int | None
    """Dimension of the constant combinations, without the number 1."""
    printed: tuple[PrintedIntegral, ...] | None
    """Those that are printed."""
    unprinted: int | None
    """How many are not."""
    reason: str | None
    """Why there is no answer."""


@dataclass(frozen=True, eq=False, repr=False)
class WatchedInvariant(Record):
    """An invariant that the system names."""

    name: str
    """Its name."""
    constant: bool
    """Whether it is constant; False is proved."""


@dataclass(frozen=True, eq=False, repr=False)
class Integrals(Record):
    """Invariant measure and first integrals: the answer of `System.integrals`."""

    scene: str
    """Name of the system."""
    formulation: str
    """Name of the formulation."""
    domain: str
    """Where the answers hold."""
    measure: InvariantMeasure | None
    """The measure; None for another formulation than Chetaev's."""
    multipliers: tuple[TimeChange, ...] | None
    """Changes of time; None for another formulation, or if the question is open."""
    polynomials: tuple[PolynomialIntegrals, ...] | None
    """Polynomial integrals by degree; None for another formulation."""
    ansatz: Ansatz
    """Integrals in the ansatz."""
    invariants: tuple[WatchedInvariant, ...] | None
    """The system's own; None if none was tried."""


@dataclass(frozen=True, eq=False, repr=False)
class FilmColumn(Record):
    """A column of a film."""

    name: str
    """Its name."""
    sigma: float
    """Standard deviation of its errors."""
    estimated: bool
    """Whether that is estimated."""


@dataclass(frozen=True, eq=False, repr=False)
class Chosen(Record):
    """A number that is chosen in a design."""

    name: str
    """Its name; NAME@2 of the second film alone."""
    low: float
    """Lower bound."""
    high: float
    """Upper bound."""
    own: float
    """The system's number."""


@dataclass(frozen=True, eq=False, repr=False)
class ByStarts(Record):
    """What a search from so many starts finds."""

    starts: int
    """Number of starts, the first of a longer search."""
    value: float | None
    """The least chi squared that they lead to; None if they lead nowhere."""


@dataclass(frozen=True, eq=False, repr=False)
class DesignPoint(Record):
    """What films with some numbers show."""

    at: tuple[float, ...]
    """The numbers, in the order of `Design.chosen`."""
    value: float | None
    """The least chi squared of the second formulation, or the standard error; None if such films do not show the number."""
    numbers: dict[str, float]
    """Numbers of the second formulation there, by name."""
    minima: int
    """Minima that the search found."""
    by_starts: tuple[ByStarts, ...]
    """The same value by number of starts: half, as many and twice as many as were asked for."""
    hidden: tuple[str, ...]
    """Combinations of unknowns that such films do not show."""


@dataclass(frozen=True, eq=False, repr=False)
class Design(Record):
    """The film that would show most: the answer of `System.design`."""

    scene: str
    """Name of the system."""
    films: int
    """Number of films."""
    samples: int
    """Samples of each film."""
    columns: tuple[FilmColumn, ...]
    """What a film shows."""
    tell: tuple[str, ...] | None
    """The formulation that is right, and the one to be told from it."""
    estimate: str | None
    """The number whose standard error is to be small."""
    chosen: tuple[Chosen, ...]
    """What is chosen."""
    best: DesignPoint
    """The best choice that was found."""
    own: DesignPoint | None
    """The system's own numbers; None if these have no motion."""
    others: tuple[DesignPoint, ...]
    """Other ends of the search."""
    shortest: float | None
    """Length of the shortest film of the best motion that tells the formulations apart, to 2 %; None if none does."""
    tried: int
    """Choices that were computed."""
    without_motion: int
    """Choices of these without a motion."""


@dataclass(frozen=True, eq=False, repr=False)
class Estimate(Record):
    """A number that was fitted."""

    name: str
    """Its name; NAME@2 of the second film."""
    value: float
    """The estimate."""
    error: float | None
    """Standard error; None if no film shows it."""
    low: float | None
    """Lower end of the interval of 95 %; None if it is open."""
    high: float | None
    """Upper end."""
    profiled: bool
    """Whether the interval is that of the profile."""
    at_bound: float | None
    """Probability of an estimate as far from its bound, if that is within reach."""


@dataclass(frozen=True, eq=False, repr=False)
class ResidualTest(Record):
    """A test on residuals."""

    name: str
    """What is tested."""
    found: float
    """What was found."""
    expected: float
    """What noise gives."""
    probability: float
    """Probability of a larger deviation from noise."""
    objects: bool
    """Whether the test failed."""


@dataclass(frozen=True, eq=False, repr=False)
class Shown(Record):
    """Whether films of these columns can show the unknowns at all."""

    answer: Literal["proved", "hidden", "open"]
    """"proved" (at almost all unknowns), "hidden" (by ranks in two finite fields) or "open"."""
    hidden: tuple[tuple[str, ...], ...]
    """The unknowns of each combination that no film shows."""
    order: int | None
    """Highest derivative that was used, if something is hidden."""
    words: str
    """The answer in words."""
