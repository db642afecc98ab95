"""Altered certificates for the verifier: python certificates.py DELTAQ SECONDS [SEED]

Certificates that the program writes are altered in their bytes, numbers, names and structure. Each has to end with 0, 1 or 2 and a line,
in 30 s and 2 GB; an exception or a line without words is a failure. What still verifies is counted."""

import contextlib, copy, io, json, pathlib, random, resource, signal, subprocess, sys, tempfile, time

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "proof"))
import verify

ODD = ["", "0", "-1", "1/0", "1e400", "x", "9" * 5000, "(" * 3000, "x^" * 900 + "x", "sqrt(-1)", "2^(2^99)", "atan2(0, 0)", "\0", "é", "nan"]
THINGS = [None, True, [], {}, -1, 0, 2**70, 1e308, [[]], {"": 0}]

def written(program, folder):
    """Certificates of some scenes, as texts."""
    for scene in "sledge", "sleigh", "particle", "disc":
        subprocess.run([program, "prove", scene, "--out", folder / f"{scene}.json", "--quiet"], capture_output=True)
        subprocess.run([program, "integrals", scene, "--degree", "1", "--certificates", folder / scene, "--quiet"], capture_output=True)
    return [path.read_text() for path in sorted(folder.rglob("*.json"))]

def places(value):
    """Every list or object in it, with its keys."""
    keys = range(len(value)) if isinstance(value, list) else list(value) if isinstance(value, dict) else []
    for key in keys:
        yield value, key
        yield from places(value[key])

def altered(draw, text):
    if draw.random() < 0.2:
        at = draw.randrange(len(text))
        return text[:at] + draw.choice(["", "[", "}", '"', "\\", "0", "9" * 400, text[at : at + 40] * 3]) + text[at + draw.randrange(9) :]
    value = json.loads(text)
    for _ in range(draw.choice([1, 1, 2, 5])):
        holder, key = draw.choice(list(places(value)))
        old, kind = holder[key], draw.random()
        if kind < 0.15:
            del holder[key]
        elif kind < 0.35:
            holder[key] = copy.deepcopy(draw.choice(THINGS))
        elif kind < 0.55:
            holder[key] = draw.choice(ODD)
        elif isinstance(old, int):
            holder[key] = old + draw.choice([-1, 1, 2**61 - 2, -old])
        elif isinstance(old, str):
            at = draw.randrange(len(old) + 1)
            holder[key] = old[:at] + draw.choice("0123456789+-*/^().'xyt ") + old[at + draw.randrange(2) :]
        else:
            # a copy: a value put into itself would have no end
            holder[key] = copy.deepcopy(draw.choice([held[k] for held, k in places(value)]))
        if not list(places(value)):
            break
    return json.dumps(value)

def main(program, seconds, seed=0):
    resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
    folder, draw, codes, failures = pathlib.Path(tempfile.mkdtemp()), random.Random(int(seed)), {}, 0
    texts, end = written(program, folder), time.monotonic() + float(seconds)
    def late(*_):
        raise TimeoutError("not in 30 s")
    signal.signal(signal.SIGALRM, late)
    while time.monotonic() < end:
        text, said = altered(draw, draw.choice(texts)), io.StringIO()
        (folder / "altered").write_text(text)
        signal.alarm(30)
        try:
            with contextlib.redirect_stdout(said):
                code = verify.main(str(folder / "altered"))
            assert code in (0, 1, 2) and len(said.getvalue().strip()) > 12, said.getvalue()
        except BaseException as fault:
            code, failures = "failed", failures + 1
            (folder / f"failure-{failures}.json").write_text(text)
            print(f"{type(fault).__name__}: {str(fault)[:200]}: {folder}/failure-{failures}.json", flush=True)
        finally:
            signal.alarm(0)
        codes[code] = codes.get(code, 0) + 1
    print(f"{sum(codes.values())} certificates, altered from {len(texts)}: {codes}")
    return 1 if failures or not texts else 0

if __name__ == "__main__":
    sys.modules["verify"] = verify
    sys.exit(main(*sys.argv[1:]))
