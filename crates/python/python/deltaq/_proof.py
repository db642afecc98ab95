"""Certificates that no multipliers make the vakonomic motion Chetaev's, as `deltaq prove` writes them."""

import hashlib
import json
import os
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
    fields, because = self._certificate(almost_every_start)
    if fields is not None:
        plain = json.dumps(fields["scene"], sort_keys=True, separators=(",", ":"), ensure_ascii=False)
        fields["digest"] = f"sha256:{hashlib.sha256(plain.encode()).hexdigest()}"
        fields = {"schema": _SCHEMA} | json.loads(json.dumps(fields, sort_keys=True))
    return Proof(fields, because)
