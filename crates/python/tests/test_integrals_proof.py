"""Certificates of `deltaq integrals`, made by hand and forged, are verified by a script that shares no code with it.

Chaplygin's sleigh: blade at (x, y), mass m at a before it, moment of inertia J about the mass. With X_1 = [1, tan, 0], X_2 = [0, 0, 1],
kappa = m a/(J + m a^2): tau_1 = kappa/cos, tau_2 = -tan, and X_1, X_2, [X_1, X_2], [X_2, [X_1, X_2]] with their tau have the determinant
-kappa/cos^3.
"""

import copy
import json
import subprocess
from fractions import Fraction

import pytest
import test_proof
from test_proof import CATALOGUE, FORGED, PROGRAM, SCRIPT, UNREADABLE, VERIFIED, changed, changes, same_function, scene_file, signed, verdict, written

SLEIGH = "m/2*((x' - a*phi'*sin(phi))^2 + (y' + a*phi'*cos(phi))^2) + J/2*phi'^2"
BLADE = "y'*cos(phi) - x'*sin(phi)"
FREE = ["x'", "phi'"]


@pytest.fixture(scope="module")
def images(tmp_path_factory):
    """Images mod p as the program writes them."""
    true = written(tmp_path_factory.mktemp("images"), CATALOGUE / "scenes" / "sledge.toml")
    return {name: true[name] for name in ("prime", "unity", "exponents", "roots")}


def plain(lagrangian, constraints, parameters=None, forces=None, time="1/3", **positions):
    fields = {"coordinates": list(positions), "parameters": parameters or {}, "lagrangian": lagrangian, "constraints": constraints}
    return fields | {"forces": forces or {}, "time": time, "positions": positions, "velocities": {}}


def sleigh(a="1/3", potential="0", phi="0", constraints=(BLADE,)):
    return plain(f"{SLEIGH} - ({potential})", list(constraints), {"m": "2", "a": a, "J": "3/4"}, x="1/7", y="2/5", phi=phi)


def certificate(images, kind, scene, **fields):
    return signed({"schema": "deltaq/integrals-certificate/1", "kind": kind, "scene": scene, "set": {}} | images | fields)


def modulo(images, x):
    x = Fraction(x)
    return x.numerator * pow(x.denominator, -1, images["prime"]) % images["prime"]


def no_measure(images, factor=1, **changes):
    kappa = Fraction(2, 3) / (Fraction(3, 4) + Fraction(2, 9))
    fields = {"free": FREE, "brackets": [[0, 1], [1, 2]], "rows": [0, 1, 2, 3], "minor": modulo(images, -kappa * factor)}
    return certificate(images, "no measure", changes.pop("scene", sleigh()), **fields | changes)


def measure(images, scene, metric="1/2", free=FREE, **angles):
    return certificate(images, "measure", scene, free=free, density={"metric": metric, "angles": angles})


def straight(images, scene):
    """The chart q = q0 + z."""
    names, number = scene["coordinates"], lambda x: modulo(images, scene["positions"][x])
    return {x: [[[0] * len(names), number(x)], [[int(x == y) for y in names], 1]] for x in names}


def bound(images, scene, degree, order, bound, weights=(1, 2, 1), free=FREE, **changes):
    fields = {"degree": degree, "free": free, "weights": list(weights), "order": order, "chart": straight(images, scene), "bound": bound}
    return certificate(images, "bound", scene, **fields | changes)


def integral(images, scene, text):
    return certificate(images, "integral", scene, integral=text)


def test_the_sleigh_has_no_measure(images, tmp_path):
    code, said = verdict(tmp_path, no_measure(images))
    assert code == VERIFIED and said.startswith("verified: near almost every point no measure") and "up to 3 fields" in said
    # from another angle with the images of e^i: cos 2 = (e^2i + e^-2i)/2
    p, up = images["prime"], pow(images["exponents"]["e^i"], 2, images["prime"])
    cosine = (up + pow(up, -1, p)) * pow(2, -1, p) % p
    minor = no_measure(images)["minor"] * pow(cosine, -3, p) % p
    assert verdict(tmp_path, no_measure(images, scene=sleigh(phi="2"), minor=minor))[0] == VERIFIED
    # an odd order turns the sign, a row less or twice is no proof
    assert verdict(tmp_path, no_measure(images, -1, rows=[1, 0, 2, 3]))[0] == VERIFIED
    assert verdict(tmp_path, no_measure(images, -1)) == (FORGED, "forged: the minor\n")
    assert verdict(tmp_path, no_measure(images, 0, rows=[0, 1, 2, 2])) == (FORGED, "forged: the minor\n")
    assert verdict(tmp_path, no_measure(images, rows=[0, 1, 2])) == (FORGED, "forged: the rows\n")
    assert verdict(tmp_path, no_measure(images, brackets=[[0, 1]])) == (FORGED, "forged: the rows\n")
    assert verdict(tmp_path, no_measure(images, brackets=[[0, 3], [1, 2]])) == (FORGED, "forged: a bracket of what comes later\n")
    deep = [[0, 1], *([1, k] for k in range(2, 21))]
    assert verdict(tmp_path, no_measure(images, brackets=deep)) == (UNREADABLE, "cannot read: that many brackets\n")
    # a potential does not enter
    assert verdict(tmp_path, no_measure(images, scene=sleigh(potential="x^3*exp(y) + sin(phi)")))[0] == VERIFIED


def test_the_sleigh_over_its_blade_has_a_measure(images, tmp_path):
    over = sleigh(a="0")
    for scene in over, sleigh(a="0", potential="x^3*y + cos(phi)"):
        for density, words in ((("1/2", {}), "|det g|^(1/2) dq ds"), (("0", {"phi": ["0", "-1"]}), "measure |cos(phi)|^(-1) dq ds")):
            code, said = verdict(tmp_path, measure(images, scene, density[0], **density[1]))
            assert code == VERIFIED and words in said
        for metric, sine, cosine in (("-1/2", "0", "0"), ("1", "0", "0"), ("0", "0", "0"), ("0", "0", "1"), ("0", "-1", "0"), ("1/2", "0", "-1")):
            assert verdict(tmp_path, measure(images, scene, metric, phi=[sine, cosine])) == (FORGED, "forged: the measure is not invariant\n")
    assert verdict(tmp_path, measure(images, over, "1/2", ["phi'", "y'"]))[0] == VERIFIED
    assert verdict(tmp_path, no_measure(images, scene=over))[0] == FORGED
    for metric in ("1/2", "0", "1"):
        assert verdict(tmp_path, measure(images, sleigh(), metric))[0] == FORGED
    for metric in ("x", "1/0", "0.5", "1e9", ""):
        assert verdict(tmp_path, measure(images, over, metric))[0] == UNREADABLE
    assert verdict(tmp_path, measure(images, over, psi=["0", "0"])) == (FORGED, "forged: an angle that is not a coordinate\n")


def multiplier(images, scene, metric, free=FREE, **angles):
    return certificate(images, "multiplier", scene, free=free, density={"metric": metric, "angles": angles})


def no_multiplier(images, scene, free=FREE):
    return certificate(images, "no multiplier", scene, free=free)


def test_the_sleigh_over_its_blade_has_a_multiplier(images, tmp_path):
    over = sleigh(a="0")
    for scene in over, sleigh(a="0", potential=f"{FREE[0][0]}^3 + cos(phi)"):
        for metric, angles in (("-1/2", {}), ("0", {"phi": ["0", "1"]})):
            code, said = verdict(tmp_path, multiplier(images, scene, metric, **angles))
            assert code == VERIFIED and said.startswith("verified: with dtau = f dt, f = |") and "is Hamilton's" in said
        for metric, sine, cosine in (("1/2", "0", "0"), ("-1", "0", "0"), ("0", "0", "0"), ("0", "0", "-1"), ("0", "1", "0"), ("-1/2", "0", "1")):
            assert verdict(tmp_path, multiplier(images, scene, metric, phi=[sine, cosine])) == (FORGED, "forged: the motion is not Hamilton's\n")
        assert verdict(tmp_path, no_multiplier(images, scene)) == (FORGED, "forged: the slopes solve their equations\n")
    code, said = verdict(tmp_path, no_multiplier(images, sleigh()))
    assert code == VERIFIED and said.startswith("verified: near almost every point there is no f(r)")
    for metric in ("-1/2", "0", "1"):
        assert verdict(tmp_path, multiplier(images, sleigh(), metric))[0] == FORGED
    # with a potential of x and y it is no motion over one of these
    reason = "cannot read: what is solved for are not velocities of symmetries\n"
    assert verdict(tmp_path, no_multiplier(images, sleigh(potential="x*y"))) == (UNREADABLE, reason)
    assert verdict(tmp_path, multiplier(images, over, "0", x=["0", "0"], y=["0", "0"])) == (FORGED, "forged: an angle that the motion is not over\n")


def test_integrals_are_counted(images, tmp_path):
    # over the blade: phi', u, phi' x - u sin, phi' y + u cos, phi' (x^2 + y^2)/2 - u (x sin - y cos); and 15 of degree 2
    for scene, degree, order, number in ((sleigh(a="0"), 1, 3, 5), (sleigh(a="0"), 2, 6, 15), (sleigh(), 1, 6, 2), (sleigh(), 2, 10, 4)):
        true = bound(images, scene, degree, order, number)
        code, said = verdict(tmp_path, true)
        assert code == VERIFIED and f"at most {number} linearly independent" in said and f"order {order} " in said
        for other in number - 1, number + 1, 0:
            assert verdict(tmp_path, true | {"bound": other}) == (FORGED, f"forged: the bound, which is {number}\n")
        assert verdict(tmp_path, true | {"order": 2}) == (FORGED, "forged: terms of the last weight are free\n")
    for potential in ("x^2 + x*y^3", "cos(phi)*x + y^2/3"):
        for degree, order, number, words in ((1, 6, 0, "no integral is linear"), (2, 9, 2, "no integral but energy and constants is quadratic")):
            code, said = verdict(tmp_path, bound(images, sleigh(potential=potential), degree, order, number))
            assert code == VERIFIED and words in said


def test_forces_leave_no_energy(images, tmp_path):
    # 1 and phi'^2
    pushed = sleigh(a="0") | {"forces": {"x": "y^2*x", "y": "x^3 + 1"}}
    code, said = verdict(tmp_path, bound(images, pushed, 2, 8, 2))
    assert code == VERIFIED and "at most 2 linearly independent" in said and "energy" not in said
    code, said = verdict(tmp_path, bound(images, sleigh() | {"forces": {"x": "y^2*x", "y": "x^3 + 1"}}, 2, 8, 1))
    assert code == VERIFIED and "at most 1 linearly independent" in said


def test_any_chart_that_fits_will_do(images, tmp_path):
    scene = sleigh(a="0")
    true = bound(images, scene, 1, 3, 5)
    def charted(**terms):
        chart = copy.deepcopy(true["chart"])
        for name, more in terms.items():
            chart[name] += more
        return verdict(tmp_path, true | {"chart": chart})
    # terms of weight 2 in y, and anything of higher weight
    assert charted(y=[[[2, 0, 0], 7], [[1, 0, 1], 5]], x=[[[0, 1, 0], 3], [[2, 0, 0], 11]], phi=[[[1, 0, 0], 2], [[0, 3, 1], 5]])[0] == VERIFIED
    assert charted(y=[[[1, 0, 0], 1]]) == (FORGED, "forged: a field lowers weights by more than one\n")
    assert charted(phi=[[[0, 0, 0], 1]])[0] == UNREADABLE
    for name, terms, words in (
        ("x", [[[0, 0, 0], 1], [[1, 0, 0], 1]], "the point of the chart"),
        ("phi", [[[0, 0, 2], 1]], "the linear part of the chart"),
        ("phi", [[[1, 0, 0], 1]], "the linear part of the chart"),
    ):
        assert verdict(tmp_path, true | {"chart": true["chart"] | {name: terms}}) == (FORGED, f"forged: {words}\n")
    for chart in (true["chart"] | {"z": []}, {x: terms for x, terms in true["chart"].items() if x != "y"}):
        assert verdict(tmp_path, true | {"chart": chart}) == (FORGED, "forged: the coordinates of the chart\n")
    for weights in ([1, 1, 1], [2, 1, 1], [1, 3, 1], [2, 4, 2], [1, 2, 2]):
        assert verdict(tmp_path, true | {"weights": weights})[0] == FORGED
    for weights in ([1, 2], [1, 2, 0], [1, 2, 1, 1]):
        assert verdict(tmp_path, true | {"weights": weights})[0] == UNREADABLE


def test_a_point_where_brackets_fall_short_bounds_nothing(images, tmp_path):
    # [X_1, X_2] = 2 x d/dz is 0 at x = 0 alone
    martinet = lambda x: plain("(x'^2 + y'^2 + z'^2)/2", ["z' - x^2*y'"], x=x, y="1/3", z="0")
    free = ["x'", "y'"]
    for weights in ((1, 1, 3), (1, 1, 2)):
        code, said = verdict(tmp_path, bound(images, martinet("0"), 1, 6, 2, weights, free))
        assert code == FORGED and "the ranks of brackets" in said
    chart = straight(images, martinet("1/2"))
    chart["z"].append([[0, 1, 0], modulo(images, "1/4")])  # z - y/4 has weight 2
    # x', r y', y x' - r y' int dx/r, z x' - r y' int x^2 dx/r with r = (1 + x^4)^(1/2)
    code, said = verdict(tmp_path, bound(images, martinet("1/2"), 1, 5, 4, (1, 1, 2), free, chart=chart))
    assert code == VERIFIED and "at most 4" in said


def test_integrals_are_constant(images, tmp_path):
    over = sleigh(a="0")
    energy = f"{SLEIGH} + x^2"
    turntable = written(tmp_path, CATALOGUE / "scenes" / "turntable.toml")
    table = turntable["scene"] | {"velocities": {}}
    pushed = plain("x'^2/2", [], forces={"x": "t - k*x'"}, parameters={"k": "0"}, x="1")
    for scene, text in (
        (over, "phi'"), (over, "x'*cos(phi) + y'*sin(phi)"), (over, "phi'*x - (x'*cos(phi) + y'*sin(phi))*sin(phi)"), (over, "(phi' + 1)^3/phi'"),
        (sleigh(potential="x^2"), energy), (pushed, "x' - t^2/2"),
        (table, "x' + 2*Omega/7*y"), (table, "y' - 2*Omega/7*x"), (table, "psi' + phi'*cos(theta)"),
    ):
        code, said = verdict(tmp_path, integral(images, scene, text))
        assert code == VERIFIED and said.startswith(f"verified: {text} ") and "is constant along Chetaev's motions" in said
    assert "with J = 3/4, a = 1/3, m = 2 is" in verdict(tmp_path, integral(images, sleigh(potential="x^2"), energy))[1]
    for scene, text in (
        (over, "x'"), (over, "x'*cos(phi) - y'*sin(phi)"), (sleigh(), "phi'"), (sleigh(potential="x^2"), SLEIGH), (sleigh(), f"{SLEIGH} + x"),
        (pushed, "x' - t^2/3"), (pushed, "t"), (table, "x' + 2*Omega/5*y"), (table, "y' + 2*Omega/7*x"),
        (plain("x'^2/2", [], forces={"x": "-x'"}, x="1"), "x'"),
    ):
        assert verdict(tmp_path, integral(images, scene, text)) == (FORGED, "forged: the integral is not constant along Chetaev's motions\n")
    for text in ("0", "7*m", BLADE, f"1 + ({BLADE})^2*x", "x'/x'"):
        assert verdict(tmp_path, integral(images, over, text)) == (FORGED, "forged: the integral is a constant where f = 0\n")
    assert verdict(tmp_path, integral(images, over, "phi' + beta")) == (FORGED, "forged: a name in the integral\n")
    assert verdict(tmp_path, integral(images, over, "[phi', 1]"))[0] == UNREADABLE


def test_a_quadratic_constraint_has_all_its_pieces(images, tmp_path):
    drawn, read = {"x": "1", "y": "2", "z": "1/2"}, lambda scene, text: verdict(tmp_path, integral(images, scene, text))
    cone = plain("(x'^2 + y'^2 + z'^2)/2 - z", ["x'^2 + y'^2 - 2*z'^2"], **drawn)
    assert read(cone, "(x'^2 + y'^2 + z'^2)/2 + z")[0] == read(cone, "z'^2*3/2 + z")[0] == read(cone, "x'/y'")[0] == VERIFIED
    for text in ("x'", "z'^2 + z", "y'^2 + x'*z'"):
        assert read(cone, text) == (FORGED, "forged: the integral is not constant along Chetaev's motions\n")
    assert read(cone, "(x'^2 + y'^2)/z'^2") == (FORGED, "forged: the integral is a constant where f = 0\n")
    # x' = y' and x' = -y'; the first alone has x - y
    planes = plain("(x'^2 + y'^2 + z'^2)/2 - x*z", ["x'^2 - y'^2"], **drawn)
    assert read(planes, "(x'^2 + y'^2 + z'^2)/2 + x*z")[0] == VERIFIED
    assert read(planes, "x - y")[0] == read(planes, "x + y")[0] == FORGED
    others = (["x'^4 - y'^4"], "neither affine nor quadratic"), (["x'^2"], "without regular points"), (["x'^2 - y'^2", "z'"], "several constraints")
    for constraints, words in others:
        code, said = read(planes | {"constraints": constraints}, "x - y")
        assert code == UNREADABLE and words in said


def test_images_that_hide_a_sine_prove_nothing(images, tmp_path):
    # mod p with e^i -> 1 each sine of a fraction is 0
    blind = images | {"exponents": {"order": 1, "e^i": 1, "e": 1}}
    pendulum = plain("x'^2/2 + cos(x)", [], x="1")
    assert verdict(tmp_path, integral(blind, pendulum, "x'^2/2 - cos(x)"))[0] == VERIFIED
    assert verdict(tmp_path, integral(blind, pendulum, "x'"))[0] == FORGED
    wheel = plain("(x'^2 + (2 + cos(x))*y'^2)/2", [], x="1", y="1")
    assert verdict(tmp_path, measure(blind, wheel, "1", ["x'", "y'"]))[0] == VERIFIED
    assert verdict(tmp_path, measure(blind, wheel, "0", ["x'", "y'"]))[0] == FORGED


def test_what_is_no_such_system_is_not_read(images, tmp_path):
    over, read = sleigh(a="0"), lambda scene: verdict(tmp_path, measure(images, scene))
    assert read(over)[0] == VERIFIED
    for change, words in (
        ({"lagrangian": f"{SLEIGH} + t"}, "contains t"), ({"lagrangian": f"{SLEIGH} + t - t"}, "contains t"),
        ({"constraints": [f"{BLADE} + x'*(t - t)"]}, "contains t"), ({"forces": {"x": "t"}}, "contains t"),
        ({"forces": {"x": "-x'"}}, "contain velocities"), ({"constraints": [f"{BLADE} - 1"]}, "not linear and homogeneous"),
        ({"constraints": [f"({BLADE})^2"]}, "not linear and homogeneous"), ({"constraints": [f"({BLADE})*cos(x'*y')"]}, "not known to be a fraction"),
        ({"lagrangian": f"{SLEIGH} + x*y'"}, "not quadratic"), ({"lagrangian": f"{SLEIGH} + phi'^4/9"}, "not quadratic"),
        ({"lagrangian": f"{SLEIGH} + s"}, "the name s"), ({"lagrangian": "[x'^2, y'^2]"}, "not a number"),
        ({"parameters": over["parameters"] | {"x'": "1"}}, "the name of"), ({"parameters": over["parameters"] | {"x''": "1"}}, "the name of"),
    ):
        code, said = read(over | change)
        assert code == UNREADABLE and words in said, (change, said)
    for change, words in (
        ({"constraints": []}, "the number of free"), ({"constraints": [BLADE, BLADE]}, "the number of free"),
        ({"parameters": over["parameters"] | {"t": "1"}}, "used twice"),
        ({"parameters": over["parameters"] | {"x": "1"}}, "used twice"), ({"lagrangian": f"{SLEIGH} + x'^3/y'"}, "a division by 0"),
        ({"constraints": [f"x'*y'/({BLADE})"]}, "a division by 0"), ({"velocities": {"x'": "1"}}, "velocities of a point"),
    ):
        code, said = read(over | change)
        assert code == FORGED and words in said, (change, said)
    # a constraint twice, and one that does not say y'
    for constraints, free in (([BLADE, f"2*({BLADE})"], ["phi'"]), (["phi'"], ["x'", "phi'"])):
        assert verdict(tmp_path, measure(images, over | {"constraints": constraints}, "0", free)) == (FORGED, "forged: the free velocities\n")
    for free in (["x'", "x'"], ["x'", "y"], ["x'", "t'"]):
        assert verdict(tmp_path, measure(images, over, "1/2", free)) == (FORGED, "forged: the free velocities\n")
    named = {"coordinates": ["x", "y", "t"], "lagrangian": SLEIGH.replace("phi", "t"), "constraints": [BLADE.replace("phi", "t")]}
    code, said = verdict(tmp_path, measure(images, over | named | {"positions": {"x": "1", "y": "1", "t": "1"}}, free=["x'", "t'"]))
    assert code == FORGED and "used twice" in said
    twice = plain("(x'^2 + y'^2)/2", ["x' - y'", "2*x' - 2*y'"], x="1", y="1")
    assert verdict(tmp_path, integral(images, twice, "x'")) == (FORGED, "forged: the constraints are not independent\n")
    assert verdict(tmp_path, integral(images, plain("x'*y", [], x="1", y="1"), "x'")) == (FORGED, "forged: the equations of motion are not regular\n")


def test_other_certificates_are_not_read(images, tmp_path):
    true = measure(images, sleigh(a="0"))
    for change, words in (
        ({"schema": "deltaq/integrals-certificate/2"}, "the schema"), ({"kind": "no integral"}, "the kind"), ({"kind": ["measure"]}, "the kind"),
        ({"roots": {str(k): 1 for k in range(1, 12)}}, "the roots"), ({"roots": {"x": 1}}, "the roots"), ({"unity": [2, 1]}, None),
    ):
        code, said = verdict(tmp_path, true | change)
        assert (code, said) == (UNREADABLE, f"cannot read: {words}\n") if words else code == FORGED


def test_the_scene_is_that_of_the_file(images, tmp_path):
    tables = {"coordinates": "x = { start = 0.2 }\ny = { start = -1 }\nphi = { start = 0 }", "velocities": "\"x'\" = 1\n\"phi'\" = 0.5"}
    file = lambda m="2", a="1/3": scene_file(
        tmp_path, f'lagrangian = "u/2*m + J/2*phi\'^2"\nconstraints = ["{BLADE}"]', **tables, parameters=f'm = {m}\na = "{a}"\nJ = 0.75',
        definitions="u = \"(x' - a*phi'*sin(phi))^2 + (y' + a*phi'*cos(phi))^2\"",
    )
    over = sleigh(a="0")
    off = [("1/3", true) for true in (no_measure(images), bound(images, sleigh(), 1, 6, 2))]
    for a, true in (*off, ("0", measure(images, over)), ("0", integral(images, over, "phi'"))):
        code, said = verdict(tmp_path, true, file(a=a))
        assert code == VERIFIED and "it is that of" in said
        assert verdict(tmp_path, true, file("2.001", a)) == (FORGED, "forged: m is not that of the file\n")
        assert verdict(tmp_path, true, CATALOGUE / "scenes" / "sledge.toml")[0] == FORGED
        code, said = verdict(tmp_path, true | {"set": {"m": "2"}}, file("2.001", a))
        assert code == VERIFIED and "set: m = 2\n" in said
        # another mass in the certificate
        other = true["scene"] | {"parameters": true["scene"]["parameters"] | {"m": "3"}}
        assert verdict(tmp_path, signed(true | {"scene": other}), file(a=a))[0] == FORGED
        assert verdict(tmp_path, true | {"scene": other}) == (FORGED, "forged: the digest of the scene\n")


def test_the_scene_is_that_of_the_file_to_all_orders(images, tmp_path):
    # 0 with 40 derivatives at the point of the certificate
    file = lambda more: scene_file(
        tmp_path, f'lagrangian = "{SLEIGH} - ({more})"\nconstraints = ["{BLADE}"]', "x = { start = 0 }\ny = { start = 0 }\nphi = { start = 0 }",
        "\"x'\" = 1\n\"phi'\" = 0.5", parameters='m = 2\na = "1/3"\nJ = 0.75',
    )
    for true in no_measure(images), bound(images, sleigh(), 1, 6, 2), integral(images, sleigh(), SLEIGH):
        assert verdict(tmp_path, true, file("0"))[0] == VERIFIED
        assert verdict(tmp_path, true, file("(x - 1/7)^41")) == (FORGED, "forged: the Lagrangian is not that of the file\n")


# scene files, with what is set; the first ten have no measure
REAL = [
    *(("scenes/sleigh", sets) for sets in ([], ["a=0.7"], ["m=3"], ["I=1/3"], ["a=2", "m=0.5"])), ("classics/roller-racer", []),
    *(("classics/suslov", sets) for sets in ([], ["I1=0.2"], ["K=0.01"])), ("classics/engel", []), ("scenes/sledge", []), ("scenes/heisenberg", []),
    ("scenes/particle", []), ("scenes/planar-body", []), ("scenes/turntable", []), ("classics/parallel-velocities", []),
    ("classics/martinet", []), ("classics/mobile-robot", []),
    ("classics/veselova", []),
    ("classics/nonholonomic-oscillator", []), ("classics/unicycle-in-potential", []), ("classics/rubber-ball", []), ("classics/snakeboard", []),
    ("scenes/sleigh", ["a=0"]), ("classics/suslov", ["K=0"]), ("scenes/sledge", ["g=1"]),
]


def test_certificates_of_the_program(tmp_path):
    """Of every third system, and some forged; of all of them with PROOF_CHANGES. Every kind is among them several times."""
    kinds = {"no measure": 0, "measure": 0, "multiplier": 0, "no multiplier": 0, "bound": 0, "integral": 0}
    for place, (name, sets) in enumerate(REAL if test_proof.ALL else REAL[::3]):
        scene, folder = CATALOGUE / f"{name}.toml", tmp_path / str(place)
        words = [PROGRAM, "integrals", scene, "--certificates", folder, "--quiet", *(word for text in sets for word in ("--set", text))]
        subprocess.run(words, check=True, capture_output=True)
        for file in folder.glob("*.json"):
            true = json.loads(file.read_text())
            code, said = verdict(tmp_path, true, scene)
            assert code == VERIFIED, (name, sets, file.name, said)
            kinds[true["kind"]] += 1
            first = true["scene"]["coordinates"][0]
            with_angle = lambda true=true, first=first: {"density": true["density"] | {"angles": true["density"]["angles"] | {first: ["1", "0"]}}}
            trivial = {"metric": "0", "angles": {}}
            forged = {
                "no measure": lambda true=true: {"minor": true["minor"] - 1}, "bound": lambda true=true: {"bound": true["bound"] + 1},
                "measure": with_angle, "multiplier": with_angle, "no multiplier": lambda: {"kind": "multiplier", "density": trivial},
                "integral": lambda true=true, first=first: {"integral": f"{true['integral']} + {first}"},
            }[true["kind"]]()
            code, said = verdict(tmp_path, true | forged, scene)
            assert code == FORGED, (name, sets, file.name, said)
            if sets:
                assert verdict(tmp_path, true | {"set": {}}, scene)[0] == FORGED
    assert all(count >= (10 if test_proof.ALL else 3) for count in kinds.values()), kinds
    print(kinds)


def harmless(true, path, other):
    """Why a certificate is as good with a change."""
    kind, scene = true["kind"], other["scene"]
    if path == ("scene", "parameters") and "more" in scene["parameters"]:
        return "a parameter that stands nowhere"
    if path[:2] in (("scene", "time"), ("scene", "positions")):
        here = scene["positions"]["phi"] == true["scene"]["positions"]["phi"]
        if kind in ("measure", "integral", "multiplier", "no multiplier"):
            return "the verifier draws points"
        return "x, y and t stand nowhere" if path[1] == "time" or kind == "no measure" and here else None
    if path[:2] in (("scene", "lagrangian"), ("scene", "constraints")):
        return "the same function in other words" if same_function(true["scene"], scene) else None
    if path[0] == "brackets" and other["brackets"][:2] in (true["brackets"], [[1, 0], [1, 2]]):
        return "a bracket that is in no row, or two rows with the other sign"
    if path[0] == "rows" and sorted(other["rows"]) == [0, 1, 2, 3]:
        return "rows in an even order"
    if path[0] == "order" and other["order"] > true["order"]:
        return "a bound that does not fall again"
    if path[0] == "chart" and len(path) > 1:
        before, after = ({x: {tuple(e): y for e, y in terms} for x, terms in fields["chart"].items()} for fields in (true, other))
        same = all(before[x].get((0, 0, 0), 0) == after[x].get((0, 0, 0), 0) for x in before)
        return "another scale" if same and all(after[x].get(tuple(int(x == y) for y in before)) for x in before) else None
    if path[0] == "free" and kind == "no multiplier":
        return "over other coordinates there is none, either"
    if path[0] == "free" and sorted(other["free"]) == sorted(true["free"]):
        return "the same fields in another order"
    return None


@pytest.mark.parametrize("kind", ["no measure", "measure", "multiplier", "no multiplier", "bound", "integral"])
def test_what_is_changed_is_forged_or_cannot_be_read(images, tmp_path, kind):
    # single changes, held against the file: of every field the first and each third one, or all
    over, off = sleigh(a="0", potential="x^2*y"), sleigh(potential="x^2*y + sin(phi)")
    true = {
        "no measure": lambda: no_measure(images), "measure": lambda: measure(images, over, "1/4", phi=["0", "-1/2"]),
        "bound": lambda: bound(images, sleigh(), 1, 6, 2), "integral": lambda: integral(images, off, f"{SLEIGH} + x^2*y + sin(phi)"),
        "multiplier": lambda: multiplier(images, sleigh(a="0"), "-1/4", phi=["0", "1/2"]), "no multiplier": lambda: no_multiplier(images, sleigh()),
    }[kind]()
    found = [(path, other) for path, other in changes(true) if path]
    if not test_proof.ALL:
        of = {}
        for path, other in found:
            of.setdefault(path[:1], []).append((path, other))
        found = [change for changes_of_field in of.values() for change in changes_of_field[::3]]
    counts = [0, 0, 0]
    file = tmp_path / "scene.toml"
    table = lambda name, fields: f"[{name}]\n" + "".join(f"{x} = {y}\n" for x, y in fields.items())
    system, starts = {"lagrangian": json.dumps(true["scene"]["lagrangian"]), "constraints": [BLADE]}, dict.fromkeys(("x", "y", "phi"), '{ start = "0" }')
    parameters = {x: f'"{y}"' for x, y in true["scene"]["parameters"].items()}
    file.write_text(table("parameters", parameters) + table("coordinates", starts) + table("system", system))
    assert verdict(tmp_path, true, file)[0] == VERIFIED
    for path, other in found:
        forged = changed(true, path, other)
        forged = signed(forged) if path[0] == "scene" and len(path) > 1 else forged
        code, said = verdict(tmp_path, forged, file)
        counts[code] += 1
        assert code != VERIFIED or harmless(true, path, forged), (path, other, said)
        assert "Error" not in said, (path, other, said)
    print(kind, *zip(("verified", "forged", "cannot be read"), counts))
    assert counts[FORGED] > 10 and counts[UNREADABLE] > 3


def test_the_script_alone_ends_with_its_code_wherever_it_stands(images, tmp_path):
    folder, path = tmp_path / "elsewhere", tmp_path / "certificate.json"
    folder.mkdir()
    for file in SCRIPT.parent.glob("*.py"):
        (folder / file.name).write_text(file.read_text())
    true = no_measure(images)
    for code, fields in enumerate((true, true | {"minor": 1}, true | {"kind": "a measure"})):
        path.write_text(json.dumps(fields))
        run = subprocess.run(["python3", folder / SCRIPT.name, path], capture_output=True, text=True, cwd=tmp_path)
        assert run.returncode == code and not run.stderr
