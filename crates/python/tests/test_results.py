"""Results as values: they are pickled and copied, cannot be written to, have the shape that was asked for."""

import copy
import io
import pickle
import subprocess
import sys
import threading
import time
import types
from pathlib import Path

import numpy as np
import pytest

import deltaq

ROUNDS = {"pickle": lambda result: pickle.loads(pickle.dumps(result)), "copy": copy.copy, "deepcopy": copy.deepcopy}


def escaping():
    """x' = u, u' = u^2 ends at t = 1/u0."""
    return deltaq.System(
        coordinates=["x", "y"], lagrangian="(x'^2 + y'^2)/2", constraints=["y' - x'"], forces={"x": "2*x'^2"},
        start={"x": 0, "y": 0}, velocities={"x'": 1.0}, duration=2.0,
    )


def same(one, two):
    """Whether two results have the same values in all that they show, to the bit."""
    if isinstance(one, np.ndarray):
        assert one.dtype == two.dtype and not two.flags.writeable
        return np.testing.assert_array_equal(one, two)
    if isinstance(one, dict):
        assert list(one) == list(two)
        return [same(one[key], two[key]) for key in one]
    if isinstance(one, (list, tuple)):
        assert len(one) == len(two)
        return [same(*pair) for pair in zip(one, two)]
    if isinstance(one, deltaq.System):
        assert one.to_toml() == two.to_toml()
    elif type(one).__module__ == "deltaq":
        assert type(one) is type(two)
        fields = [name for name, value in vars(type(one)).items() if not name.startswith("_") and not callable(value)]
        assert fields
        return [same(getattr(one, name), getattr(two, name)) for name in fields]
    else:
        assert one == two or (one != one and two != two)


@pytest.mark.parametrize("way", ROUNDS)
def test_everything_is_pickled_and_copied(sledge, system, way):
    short = sledge.system(duration=1.0)
    equations = short.equations("vakonomic", mu0=[0.2])
    results = [
        short.solve("vakonomic", [0.0, 0.5, 1.0], mu0=[0.3], tolerance=1e-9), escaping().solve(), short.compare(),
        short.start, equations.integrate([0.0, 0.5]), equations.outputs(0.0, equations.initial_state()),
        short.ensemble("vakonomic", [0.5, 1.0], vary={"mu0_1": [0.1, 0.2]}), escaping().ensemble(vary={"x'": [0.1, 3.0]}),
        system.linearize(at=0.5), deltaq.built_in("disc").connect({"psi": 3.0, "phi": 1.5}, 2.0, "chetaev", starts=2),
    ]
    for result in results:
        same(result, ROUNDS[way](result))
    again = ROUNDS[way](equations)
    assert again.text == equations.text
    np.testing.assert_array_equal(again.initial_state(), equations.initial_state())


def test_a_motion_that_was_pickled_is_read_off(sledge, system):
    short = sledge.system(duration=1.0)
    motions = [
        system.solve("vakonomic", [0.0, 2.0], mu0=[0.3]), system.solve("removed-constraint", constants={"horizon": 4}),
        system.solve(method="dop853", max_step=0.1), system.solve(form="multipliers"), system.solve(max_steps=5), escaping().solve(),
        *(run.motion for run in short.compare().runs if run.motion is not None),
    ]
    for motion in motions:
        again, t = pickle.loads(pickle.dumps(motion)), np.linspace(motion.start, motion.end, 7)
        same(motion.at(t), again.at(t))
    assert len(motions) > 8
    limited = system.solve(times=[0, 1e9], time_limit=0.05)
    again = pickle.loads(pickle.dumps(limited))
    middle = 0.5 * min(limited.end, 5.0)
    np.testing.assert_allclose(again.at(middle).coordinates, limited.at(middle).coordinates, atol=1e-8)


def test_results_cannot_be_written_to(system):
    motion, many = system.solve("vakonomic", [0, 1]), system.ensemble(vary={"g": [1.0, 2.0]})
    [pair, *_] = system.replace({"duration": 1}).compare().pairs
    arrays = [motion.times, motion.coordinates, motion.velocities, motion.coordinate_error_estimates, *motion.multipliers.values()]
    arrays += [*motion.observables.values(), *motion.invariants.values(), *motion.multiplier_error_estimates.values()]
    arrays += [many.times, many.coordinates, many.error_estimate, *many.varied.values(), *many.multipliers.values()]
    arrays += [pair.times, pair.gap, pair.limit, system.start.q, system.start.v, motion.at([0.5, 1.0]).coordinates]
    linear = system.linearize(at=0.0)
    for array in arrays + [linear.matrix, linear.eigenvalues, linear.errors]:
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    # what a function gives, and a dataset, are the caller's
    equations = system.equations()
    y = equations.initial_state()
    for array in (y, equations.rates(0, y), equations.jacobian(0, y), system.constraint(0, *(y[:3], y[3:6])), system.mass(0, y[:3], y[3:6])):
        array[...] = 0
    motion.to_xarray()["x"][...] = 0


def test_one_rule_for_what_is_not_reached():
    system, times = escaping(), [0.0, 0.5, 0.9, 1.1, 1.2]
    motion, run = system.solve(times=times), system.equations().integrate(times)
    many = system.ensemble(times=times, vary={"x'": [1.0]})
    assert motion.reached == run.reached == many.reached[0] == 3 and motion.status == run.status == many.status[0] == "stopped"
    for array in (motion.coordinates, run.states, many.coordinates[0], motion.coordinate_error_estimates):
        assert len(array) == 5 and np.isfinite(array[:3]).all() and np.isnan(array[3:]).all()
    for values in [*motion.multipliers.values(), *motion.invariants.values(), *motion.multiplier_error_estimates.values()]:
        assert np.isfinite(values[:3]).all() and np.isnan(values[3:]).all()
    np.testing.assert_array_equal(motion.times, times)
    np.testing.assert_array_equal(run.times, times)
    assert motion.to_arrow()["x"].null_count == 2 and len(motion.to_pandas()) == 5 and "t = 0.9" in motion._repr_html_()
    motion.plot()
    for wrong in (lambda t: system.solve(times=t), lambda t: system.equations().integrate(t), lambda t: system.ensemble(times=t, vary={"x'": [1.0]})):
        with pytest.raises(ValueError, match="0.5 comes after 0.6"):
            wrong([0.6, 0.5])


@pytest.mark.parametrize(("start", "last"), [(0.0, 0.3), (0.1, 0.7), (-0.3, 0.1), (1e3, 1e3 + 0.1)])
def test_the_last_digit_of_a_time_does_not_count(sledge, start, last):
    system = sledge.system(time=start, removals={})
    motion = system.solve(times=[start, last])
    assert motion.status == "completed" and motion.reached == 2
    for t in (motion.end, np.nextafter(motion.end, np.inf), last):
        np.testing.assert_allclose(motion.at(t).coordinates, motion.coordinates[-1], atol=1e-12)
    motion.at(np.nextafter(start, -np.inf))
    for run in (system.solve(times=[np.nextafter(start, -np.inf), last]), system.equations().integrate([np.nextafter(start, -np.inf), last])):
        assert run.reached == 2
    with pytest.raises(ValueError, match="outside of the motion"):
        motion.at(last + 1e-9 * max(1, abs(last)))


@pytest.mark.parametrize("ask", ["rates", "jacobian", "outputs", "at", "constraint", "mass"])
def test_other_threads_go_on_meanwhile(system, ask):
    equations, motion = system.equations("vakonomic"), system.solve()
    count = 20_000 if ask in ("outputs", "at") else 200_000
    y, t = np.tile(equations.initial_state(), (count, 1)), np.zeros(count)
    q, v = np.tile(system.start.q, (count, 1)), np.tile(system.start.v, (count, 1))
    work = {
        "rates": lambda: equations.rates(0, y), "jacobian": lambda: equations.jacobian(0, y[: count // 5]),
        "outputs": lambda: equations.outputs(0, y), "at": lambda: motion.at(t),
        "constraint": lambda: system.constraint(0, q, v), "mass": lambda: system.mass(0, q, v),
    }[ask]
    work()

    def parts():
        """The longest time without a turn of another thread, and the time of three calls."""
        longest, last, done = [0.0], [time.perf_counter()], threading.Event()

        def tick():
            while not done.is_set():
                now = time.perf_counter()
                longest[0], last[0] = max(longest[0], now - last[0]), now
                time.sleep(1e-4)

        began = time.perf_counter()
        held = threading.Thread(target=lambda: [work() for _ in range(3)])
        ticking = threading.Thread(target=tick)
        ticking.start()
        held.start()
        held.join()
        done.set()
        ticking.join()
        return longest[0], time.perf_counter() - began

    # with the lock held there never is a turn in a third of that time; a busy machine keeps one waiting as long now and then
    tries = (parts() for _ in range(20))
    assert any(longest < 0.25 * whole for longest, whole in tries)


def test_threads_that_share_equations(system):
    equations = system.equations("vakonomic")
    y = equations.initial_state() + 0.01 * np.random.default_rng(1).normal(size=(500, len(equations.states)))
    expected, found = [equations.rates(0, row) for row in y], {}
    run = equations.integrate([0, 1.0]).states

    def work(k):
        found[k] = [equations.rates(0, row) for row in y]
        np.testing.assert_array_equal(equations.integrate([0, 1.0]).states, run)

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 4 and all(np.array_equal(rows, expected) for rows in found.values())


def test_a_figure_of_the_caller_stays_open(system):
    plt = pytest.importorskip("matplotlib.pyplot")
    before = plt.get_fignums()
    figure, axes = plt.subplots(3, 1)
    motion = system.solve("chetaev", [0, 1])
    assert motion.plot(ax=axes) is figure and plt.fignum_exists(figure.number)
    assert motion.plot() is not figure
    plt.close(figure)
    assert plt.get_fignums() == before


def test_units_are_told(system):
    motion, many = system.solve("chetaev", [0, 1]), system.ensemble("chetaev", [0.5, 1], vary={"phi'": [1.0, 2.0]})
    assert [axis.get_ylabel() for axis in motion.plot().axes] == ["x (m)", "y (m)", "phi (rad)"]
    assert motion.plot().axes[-1].get_xlabel() == "t (s)"
    for result in (motion, many):
        table, data = result.to_arrow(), result.to_xarray()
        for name, unit in {"x": "m", "phi": "rad", "x'": "m/s", "t": "s"}.items():
            assert table.schema.field(name).metadata == {b"units": unit.encode()} and data[name].attrs == {"units": unit}
        assert table.schema.field("energy").metadata is None
    assert many.to_xarray()["set phi'"].attrs == {"units": "rad/s"}
    swept = deltaq.sweep(system.replace({"duration": 1}), {"phi'": [0.5, 1.0]})
    assert swept.to_arrow().schema.field("apart").metadata == {b"units": b"s"} and swept.plot().axes[0].get_xlabel() == "phi' (rad/s)"


def test_members_are_counted_from_zero(system):
    many = system.ensemble(vary={"g": [1.0, 2.0, 3.0]})
    table, data = many.to_arrow(), many.to_xarray()
    assert table["member"].to_pylist() == data["member"].values.tolist() == [0, 1, 2]
    for member in range(3):
        assert table["x"][member].as_py() == many.coordinates[member, 0, 0] == data["x"].sel(member=member).values[0]
    assert deltaq.ensemble(system, vary={"g": [1.0, 2.0, 3.0]}, part=2)["member"].to_pylist() == [0, 1, 2]


@pytest.mark.parametrize(
    "ask",
    [
        lambda s: s.solve("hertz"), lambda s: s.solve(removal="tangent", formulation="removed-constraint"), lambda s: s.solve(method="rk99"),
        lambda s: s.solve(form="oblique"), lambda s: s.compare(fits="some"), lambda s: s.replace({"gg": 1}),
        lambda s: deltaq.parse(s.to_toml(), {"gg": 1}), lambda s: s.ensemble(vary={"gg": [1]}), lambda s: deltaq.sweep(s, {"gg": [1]}),
        lambda s: deltaq.sweep(s, {"g": [1]}, formulations=["chetaev", "hertz"]), lambda s: s.linearize(free=["z"], at=0.0),
        lambda s: s.linearize("hertz"), lambda s: s.equations("hertz"), lambda s: s.linearize_over({"gg": [1]}),
        lambda s: deltaq.sweep(s.replace({"duration": 1}), {"g": [1, 2]}).plot("gap"), lambda s: s.replace({"duration": 1}).compare().pair("hertz", "chetaev"),
        lambda s: s.replace({"mu1": 1}), lambda s: s.ensemble("vakonomic", vary={"mu1": [1]}), lambda s: deltaq.sweep(s, {"mu1": [1]}),
        lambda s: s.replace({"mu0_2": 1}),
    ],
)
def test_an_unknown_name_is_of_one_class(system, ask):
    with pytest.raises(deltaq.UnknownNameError) as caught:
        ask(system)
    assert isinstance(caught.value, deltaq.DeltaqError) and isinstance(caught.value, ValueError)
    assert "(mu1" not in str(caught.value)


def test_one_spelling_of_a_multiplier(system):
    expected = system.solve("vakonomic", [0, 1], mu0=[0.3])
    [name] = expected.constants
    assert name == "mu0_1" and system.replace({name: 0.3}).multipliers == [0.3]
    np.testing.assert_array_equal(system.replace({name: 0.3}).solve("vakonomic", [0, 1]).coordinates, expected.coordinates)
    many = system.ensemble("vakonomic", [1], vary={name: [0.3]})
    np.testing.assert_allclose(many.coordinates[0, 0], expected.coordinates[1], atol=1e-10)
    assert list(many.varied) == [name]
    swept = deltaq.sweep(system.replace({"duration": 1}), {name: [0.0, 0.3]})
    assert swept.to_pandas()["largest"].nunique() == 2


def test_files_that_are_not_there(tmp_path):
    with pytest.raises(FileNotFoundError) as caught:
        deltaq.load(tmp_path / "nothing.toml")
    assert caught.value.filename == str(tmp_path / "nothing.toml") and caught.value.errno == 2


def test_a_number_in_the_place_of_a_list_is_named(system):
    equations = system.equations()
    y = equations.initial_state()
    for name, ask in {
        "mu0": lambda: system.solve("vakonomic", mu0=0.3),
        "g": lambda: system.ensemble(vary={"g": 1.0}), "q": lambda: equations.acceleration(0, 1.0, y[3:6]), "constants": lambda: system.solve("vakonomic", constants=0.3),
        "phi": lambda: deltaq.sweep(system, {"phi": 1.0}), "k": lambda: deltaq.ensemble(system, vary={"k": 1.0}), "alpha": lambda: system.linearize_over({"alpha": 1.0}),
    }.items():
        with pytest.raises(ValueError, match=rf"\b{name.strip()}\b.*is a number"):
            ask()
    with pytest.raises(ValueError, match=r"times has shape \[1, 2\]; a number or \(k,\) is needed"):
        system.solve(times=[[0, 1]])


def test_all_names_are_seen():
    assert set(deltaq.__all__) <= set(dir(deltaq))


def test_without_pyarrow_the_extra_is_named():
    """Everything else works there, and help has all names."""
    code = """
import sys
for name in ("pyarrow", "pandas", "xarray", "matplotlib"):
    sys.modules[name] = None
import deltaq, inspect
from deltaq import *
assert dict(inspect.getmembers(deltaq))["sweep"] is deltaq.sweep
system = System(["x"], "x'^2/2", start={"x": 0}, velocities={"x'": 1})
motion, many = system.solve(), system.ensemble(vary={"x": [0, 1]})
asked = {
    "tables": [lambda: deltaq.sweep(system, {"x": [1]}), lambda: deltaq.ensemble(system, vary={"x": [1]}), motion.to_arrow, motion.to_pandas, motion.to_xarray, many.to_pandas, many.to_xarray],
    "plot": [motion.plot, many.plot],
}
for extra, calls in asked.items():
    for ask in calls:
        try:
            ask()
        except ImportError as error:
            assert f"the extra [{extra}] of deltaq" in str(error), error
        else:
            raise AssertionError(ask)
"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_what_scenes_say_is_there(sledge):
    switched = sledge.system(breakpoints=[0.5, 1.5], notes='two lines\nof "remarks"', duration=2.0)
    assert switched.breakpoints == [0.5, 1.5] and switched.notes == 'two lines\nof "remarks"'
    again = deltaq.parse(switched.to_toml())
    assert (again.breakpoints, again.notes) == (switched.breakpoints, switched.notes)
    assert sledge.system().breakpoints == [] and sledge.system().notes == ""


def test_figures_obey_no_text_of_a_scene(sledge):
    """A formula that matplotlib cannot read would end the drawing."""
    bad = r"$\href{x}{y}$"
    removals = {bad: {"parameters": ["u", "phi"], "rates": {"x": "u'*cos(phi)", "y": "u'*sin(phi)"}}}
    system = sledge.system(title=bad, units={"x": bad}, removals=removals, duration=0.2)
    drawn = [system.solve(), system.ensemble(vary={"x": [0.0, 0.1]}), system.compare(), deltaq.sweep(system, {"x": [0.0, 0.1]})]
    for result in drawn:
        result.plot().savefig(io.BytesIO())


def test_any_mapping_will_do(sledge, system):
    """Stubs say Mapping."""
    fixed = types.MappingProxyType
    assert deltaq.parse(system.to_toml(), fixed({"g": 1.0})).parameters["g"] == system.replace(fixed({"g": 1.0})).parameters["g"] == 1.0
    assert sledge.system(parameters=fixed({"g": 1.0, "alpha": 0.4, "k": 0.7}), start=fixed({"x": 0, "y": 0, "phi": 0})).parameters["g"] == 1.0
    vary = fixed({"g": [1.0, 2.0]})
    np.testing.assert_array_equal(system.ensemble("chetaev", [0.1], vary=vary).varied["g"], [1.0, 2.0])
    with pytest.raises(deltaq.SolveError, match="not a steady motion"):
        system.linearize_over(vary)
    natural = [system.solve("removed-constraint", [0.1], constants=kind({"horizon": 1.0})).constants for kind in (dict, fixed)]
    assert natural[0] == natural[1]
    with pytest.raises(TypeError, match="list.* where a dict is expected"):
        system.replace([("g", 1.0)])


def test_built_in_scenes(system):
    assert len(deltaq.SCENES) >= 40 and deltaq.SCENES[0] == "sledge"
    for name in deltaq.SCENES:
        assert deltaq.built_in(name).name == name
    folder = Path(__file__).resolve().parents[2] / "scene/scenes"
    for name in ("sledge", "bicycle"):
        ours, file = deltaq.built_in(name, {"time": 0.0}), deltaq.load(folder / f"{name}.toml")
        assert ours.to_toml() == file.to_toml() and ours.title == file.title
    assert deltaq.built_in("sledge", {"g": 1.6}).parameters["g"] == 1.6
    assert deltaq.built_in("n-trailer-5").dimension == 18
    with pytest.raises(deltaq.UnknownNameError, match="unknown built-in scene `sled`; known: sledge, .*n-trailer-N"):
        deltaq.built_in("sled")
