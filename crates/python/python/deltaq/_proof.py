"""Certificates as `deltaq prove` writes them; invariant measures and first integrals as `deltaq integrals` answers."""

import json
import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ._native import System

_SCHEMA = "deltaq/certificate/2"


@dataclass(frozen=True)
class Proof:
    """`certificate`: what others can check, by JSON's types; None where there is none, and then `because` says why."""

    certificate: dict[str, Any] | None
    because: str | None

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the certificate as `deltaq prove` does. ValueError where there is none."""
        if self.certificate is None:
            raise ValueError(f"there is no certificate: {self.because}")
        text = json.dumps(self.certificate, indent=2, ensure_ascii=False)
        Path(path).write_text(text + "\n", "utf-8")

    def __bool__(self) -> bool:
        return self.certificate is not None


def prove(self: System, almost_every_start: bool = False) -> Proof:
    """Proves that no multipliers mu0 make the vakonomic motion Chetaev's, from the start or from almost every one.

    >>> sledge.prove().certificate["order"] >= 1
    True
    """
    text, because = self._certificate(almost_every_start)
    return Proof(None if text is None else {"schema": _SCHEMA} | _sorted(json.loads(text)), because)


def _sorted(value: dict[str, Any]) -> dict[str, Any]:
    """By name, as deltaq prints what is in it."""
    by_name: dict[str, Any] = json.loads(json.dumps(value, sort_keys=True))
    return by_name


def integrals(self: System, formulation: str = "chetaev", degree: int = 2, names: Iterable[str] = ()) -> dict[str, Any]:
    """Which invariant measure and first integrals there are: printed, counted, or proved to be none.

    formulation: its own equations are looked at in the ansatz; measures and numbers of integrals are answered for
    "chetaev" alone.
    degree: the highest one in the velocities, from 1 to 3.
    names: coordinates that the functions of the ansatz contain; those in L and in the constraints if left out.

    As `deltaq integrals --format json` and its schema. Numbers count as they were written.

    >>> sledge.integrals(degree=1)["polynomials"][0]["answer"]
    'local'
    """
    if not 1 <= degree <= 3:
        raise ValueError(f"degree: {degree} is not from 1 to 3")
    found: dict[str, Any] = json.loads(self._integrals(formulation, degree, list(names)))
    return {"schema": "deltaq/integrals/1"} | found
