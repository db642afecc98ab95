"""Certificates as `deltaq prove` writes them; invariant measures and first integrals as `deltaq integrals` answers."""

import json
import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ._native import System
from ._results import Integrals


@dataclass(frozen=True, repr=False)
class Proof:
    """`certificate`: what others can check, by JSON's types; None where there is none, and then `because` says why."""

    certificate: dict[str, Any] | None
    because: str | None

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the certificate as `deltaq prove` does.

        Parameters
        ----------
        path : path
            The file.

        Raises
        ------
        ValueError
            If there is none.
        """
        if self.certificate is None:
            raise ValueError(f"there is no certificate: {self.because}")
        text = json.dumps(self.certificate, indent=2, ensure_ascii=False)
        Path(path).write_text(text + "\n", "utf-8")

    def __repr__(self) -> str:
        if self.certificate is None:
            return f"<deltaq.Proof none: {self.because}>"
        return f"<deltaq.Proof certificate of order {self.certificate.get('order')}>"

    def __bool__(self) -> bool:
        return self.certificate is not None


def prove(self: System, almost_every_start: bool = False) -> Proof:
    """Proves that no multipliers mu0 make the vakonomic motion Chetaev's.

    Parameters
    ----------
    almost_every_start : bool
        For almost every start instead of the system's own.

    Returns
    -------
    Proof
        The certificate, or why there is none.

    Raises
    ------
    SolveError
        If a motion has no start.

    Examples
    --------
    >>> sledge.prove().certificate["order"] >= 1
    True
    """
    text, because = self._certificate(almost_every_start)
    return Proof(None if text is None else json.loads(text), because)


def integrals(self: System, formulation: str = "chetaev", degree: int = 2, names: Iterable[str] = ()) -> Integrals:
    """Which invariant measure and first integrals there are: printed, counted, or proved not to exist.

    Parameters
    ----------
    formulation : str
        Its own equations are used in the ansatz; measures and numbers of integrals are answered for "chetaev" alone.
    degree : int
        The highest degree in the velocities, from 1 to 3.
    names : iterable of str
        Coordinates that the functions of the ansatz contain; by default those in L and in the constraints.

    Returns
    -------
    Integrals
        The answer of `deltaq integrals --format json`: as attributes, and as a mapping. Numbers count as they were written.

    Raises
    ------
    ValueError
        If `degree` is not from 1 to 3.
    UnknownNameError
        If a name is unknown.

    Examples
    --------
    >>> sledge.integrals(degree=1).polynomials[0].answer
    'local'
    """
    if not 1 <= degree <= 3:
        raise ValueError(f"degree: {degree} is not from 1 to 3")
    found: dict[str, Any] = json.loads(self._integrals(formulation, degree, list(names)))
    return Integrals.of(found)
