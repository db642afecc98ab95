"""Where deltaq itself is at fault: broken on purpose at a border, in a process of its own."""

import os
import subprocess
import sys

import pytest

import deltaq

SCRIPT = """
import deltaq
system = None
try:
    system = deltaq.built_in("sledge")
    system.title
    system.equations("chetaev")
    table = deltaq.sweep(system, {"k": [0.5, 1.0]})
    print(*table.to_pandas()["cause"], sep="\\n")
except Exception as fault:
    assert isinstance(fault, deltaq.FaultError) and isinstance(fault, deltaq.DeltaqError), fault
    print("none" if system is None else "system", fault, sep="\\n")
"""


def broken(border):
    environment = os.environ | {"DELTAQ_PANICS": border}
    ended = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, timeout=120, env=environment)
    assert (ended.returncode, ended.stderr) == (0, "")
    return ended.stdout.splitlines()


@pytest.mark.parametrize(("border", "far"), [("call", "none"), ("shared", "system"), ("work", "system")])
def test_a_panic_is_an_exception_of_deltaq(border, far):
    reached, fault = broken(border)
    assert reached == far
    assert fault.startswith("broken on purpose, at ") and "broken.rs:" in fault
    assert (", scene sledge, digest " in fault) == (far == "system")
    assert fault.endswith(": this is a fault of deltaq; please report it")


def test_points_of_a_sweep_have_it_as_their_cause():
    causes = broken("row")
    assert len(causes) == 2
    for cause in causes:
        assert cause.startswith("broken on purpose, at ") and ", scene sledge, digest " in cause


def test_it_is_none_of_the_refusals():
    assert issubclass(deltaq.FaultError, deltaq.DeltaqError) and not issubclass(deltaq.FaultError, deltaq.SolveError)
