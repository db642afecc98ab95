"""Verifies certificates of `deltaq integrals SCENE`, for verify.py, which reads them: python verify.py [SCENE.toml] CERTIFICATE.json

L = v'M(q)v/2 - V(q), forces Q(q), constraints A(q)v = 0; q0, a point. Where h columns of A are regular, the other m velocities s are free,
v = N(q)s, A N = 0. Fields X_b: the columns of N; g = N'MN. Chetaev's motion has N'(d/dt L_v - L_q - Q) = 0.

Almost every point: of a connected domain on which L, Q and A are analytic, N is, and g is regular. Where roots of q have branches, that
of the point of the certificate, round which points are drawn; and of the start of the file, where intervals show that no root is 0 between.

No measure. [X_a, X_b] = C_ab^c X_c + (M-orthogonal to ker A). The divergence of (q, p = g s) for dq dp is theta_b s^b with
theta_b = div X_b + C_ba^a, so e^sigma(q) dq dp is invariant if and only if X_b sigma = -theta_b =: tau_b. From Y sigma = tau_Y, Z sigma = tau_Z
follows [Y,Z] sigma = Y(tau_Z) - Z(tau_Y). If n + 1 rows [Y, tau_Y] have a determinant that is not 0 at q0, there is none at q0; as it is
analytic, there is none near almost every point. For V = 0 a measure that is smooth and positive near v = 0 has such a sigma.

Multiplier. f = 0 gives z' = B(q) r', q = (r, z); the m fields X_a lift d/dr_a, p = g r', c_abd = N_d'M [X_a, X_b] = g_cd C_ab^c, and Chetaev's
motion is p_a' = -X_a(H) - C_ab^c r'^b p_c: one over r where g, V and c contain r alone. With dtau = f(r) dt, P = f p, phi = log f it is
Hamilton's motion of H(r, P/f) if and only if C_ab^c r'^b p_c = r'^b phi_b p_a - phi_a r'^b p_b for all r', phi_a = d phi/dr_a, that is
c_abd + c_adb = phi_b g_ad + phi_d g_ab - 2 phi_a g_bd. The trace over b, d gives (m - 1) phi_a = -C_ab^b. Where these do not solve that, or
d phi_b/dr_a = d phi_a/dr_b does not hold, there is no f.

Bound. F = sum_I k_I(q) s^I, |I| = d, d - 2, ...; dF/dt = sum_I s^I s^b X_b(k_I) + k_I d(s^I)/dt. In coordinates z with weights w_i that X_b
lowers by one at most, the part of weight w - 1 contains k to weight w, with those of weight w in sum_I s^I s^b X_b^(-1)(k_I) alone, where
X^(-1) is the part that lowers by one. S_K: polynomials k of weights up to K for which the parts of weight up to K - 1 vanish. G_w: those k
of weight w alone with sum s^I s^b X_b^(-1)(k_I) = 0. If G_K = 0, the dimension of S_K is a bound:
(1) Let q0 be regular, that is, the ranks r_j of brackets of up to j fields be the same near q0. Then X_b^(-1) generate a nilpotent algebra
which acts simply transitively (Bellaiche 1996). Fields Z_i that commute with it form a frame, too, are homogeneous of weights -w_i, and those
of weight -1 generate the others. Such a Z maps G_(w+1) into G_w, as s^I are constants for it. What all of them map to 0 is constant. So
G_w = 0 follows for all w >= K, and an integral whose terms up to weight K are 0 is 0, as its lowest terms would be in G.
(2) Mod p. The order of a function (words in X_b of that length annihilate it at q0) is that of its weights, whatever the chart. Ranks mod p
are not over those at q0, these not over those at almost every point. The verifier computes the latter at a point and mod a prime that it
draws itself; where they agree, q0 is regular with these weights. Then there are such charts over the local ring of the images, S and G are
kernels of matrices over it, and their dimensions mod p are not under the true ones. Both are semicontinuous in q0, too: near almost every
point there are no more. That is why the chart may be given mod p alone.

Integral. f is affine in v, or a single one is quadratic. At drawn q, t a point with f = 0 is found on drawn lines; of a quadratic one both
points, which lie on both pieces where it has two. There a follows from d/dt L_v - L_q - Q = A' lambda, df/dt = 0, and F_q v + F_v a + F_t = 0.

Identities (a measure, an integral; that L and f are such) are verified at points, with images that the verifier draws itself: p = 1 mod M, e^i and e
of an order r over 2^60 that is prime. What is not 0 there is not so; what is 0 at 8 points is so but for chances under 2^-100. As
an identity need not hold mod the certificate's p, nobody gains by choosing that. The scene file is held against the plain scene there, too."""

import re, secrets
from fractions import Fraction
from itertools import combinations_with_replacement as multisets

import verify
from chart import BITS, POINTS, Chart, Part, Span, System, dot, own_images, root, solve, turned
from verify import MANY, NAMED, PAIR, WHOLE, WORD, Series, demand, invert, readable, slopes_of

# The claims -------------------------------------------------------------------------------------------------------------------------------

def mechanical(proof, *texts):
    """The system, and which velocities are free; it is such a one."""
    system = System(proof["scene"], *texts)
    own_images(proof)
    system.mechanical()
    theirs(proof)
    return system, system.free(proof["free"])

def theirs(proof):
    verify.map_to(proof["prime"], proof["unity"], proof["exponents"], proof["roots"])

def no_measure(proof):
    system, free = mechanical(proof)
    n, m = len(system.names), len(free)
    depths = [1] * m
    for pair in proof["brackets"]:
        demand(all(i < len(depths) for i in pair), "a bracket of what comes later")
        depths.append(sum(depths[i] for i in pair))
    readable(max(depths) <= 20 and len(depths) < 200, "that many brackets")
    chart, M, _, _, N = system.near(system.start(), free, max(depths) + 1)
    below = [[dot(row, x) for row in M] for x in N]
    g = [[dot(x, y) for y in below] for x in N]
    fields = []
    for b, X in enumerate(N):
        divergence = sum((chart.along([Series.of(int(i == j)) for j in range(n)], x) for i, x in enumerate(X)), Series.of(0))
        turns = turned([[dot(y, chart.bracket(X, Y)) for y in below] for Y in N])
        C = solve(g, turns, "the metric on the free velocities")  # C[c][a] = C_ba^c
        fields.append([*X, sum((C[a][a] for a in range(m)), divergence) * -1])
    for i, j in proof["brackets"]:
        fields.append(chart.bracket(fields[i], fields[j]))
    rows = proof["rows"]
    demand(len(rows) == n + 1 and all(i < len(fields) for i in rows), "the rows")
    minor = verify.determinant([[x.c[0] for x in fields[i]] for i in rows])
    demand(minor == proof["minor"] != 0, "the minor")
    deep = max(depths[i] for i in rows)
    return ["verified: near almost every point no measure e^sigma(q) dq dp, smooth and positive, is invariant under Chetaev's motion "
            f"(brackets of up to {deep} fields, minor {minor} mod {verify.P})"]

def factors(proof, key):
    """The exponents of det g, and of sines and cosines by coordinate."""
    fraction = lambda text: Fraction(text if re.fullmatch(r"-?\d{1,9}(/[1-9]\d{0,8})?", text) else readable(False, f"the exponent {text}"))
    angles = {x: [*map(fraction, pair)] for x, pair in proof[key]["angles"].items()}
    demand(angles.keys() <= set(proof["scene"]["coordinates"]), "an angle that is not a coordinate")
    return fraction(proof[key]["metric"]), angles

def product(metric, angles):
    powers = [("det g", metric), *((f"{word}({x})", y) for x, pair in angles.items() for word, y in zip(("sin", "cos"), pair))]
    return " ".join(f"|{word}|^({y})" for word, y in powers if y)

def measure(proof):
    metric, angles = factors(proof, "density")
    system = System(proof["scene"], *(f"{word}({x})" for x in angles for word in ("sin", "cos")))
    own_images(proof)
    system.mechanical()
    free = system.free(proof["free"])
    others = [i for i in range(len(system.names)) if i not in free]
    for _ in range(POINTS):
        at, s, line = system.draw(), [secrets.randbelow(verify.P) for _ in free], Chart([1])
        verify.resize(2)
        N = system.local(at, [Series(at[x].c[:1], at[x].first) for x in system.names], free)[3]
        v = [sum(x * row[i].c[0] for x, row in zip(s, N)) % verify.P for i in range(len(system.names))]
        q = [Series(line.split({(0,): at[x].c[0], (1,): y}), at[x].first) for x, y in zip(system.names, v)]
        M, _, _, along = system.local(at, q, free)
        # tr g^-1 dg, and the same for sines and cosines
        g = [[dot(x, [dot(row, y) for row in M]) for y in along] for x in along]
        first = lambda x: x.c[1][1] if x.c[1] else 0
        still, moving = ([[Series([term(x)]) for x in row] for row in g] for term in (lambda x: x.c[0], first))
        rates = solve(still, moving, "the metric on the free velocities")
        total = Series.of(metric) * sum(row[i].c[0] for i, row in enumerate(rates))
        values = system.run(at, q, [Series.of(0)] * len(system.names))
        for power, place in zip((y for pair in angles.values() for y in pair), system.texts):
            total += Series([first(values[place]) * invert(values[place].c[0])]) * power
        # the divergence of (q', s')
        acceleration, A, B = system.jets(at, v)
        total = total.c[0] + sum(x.c[0] * row[j].c[0] for i, row in zip(free, N) for j, x in enumerate(acceleration[i][1:]))
        series = lambda rows: [[Series([x]) for x in row] for row in rows]
        slopes = solve(series([[row[i] for i in others] for row in A]), series([[row[i] for i in others] for row in B]), "the free velocities")
        demand((total - sum(row[i].c[0] for i, row in enumerate(slopes))) % verify.P == 0, "the measure is not invariant")
    density = f"{product(metric, angles)} dq ds".strip()
    return [f"verified: the measure {density}, s = ({', '.join(proof['free'])}), g the metric of the kinetic energy in s, smooth and positive near "
            f"almost every point, is invariant under Chetaev's motion ({POINTS} drawn points mod {verify.P})"]

def reduced(proof):
    """At drawn points: the chart, g, N and c as series; they contain r alone."""
    angles = proof["density"]["angles"] if "density" in proof else {}
    system = System(proof["scene"], *(f"{word}({x})" for x in angles for word in ("sin", "cos")))
    own_images(proof)
    system.mechanical()
    demand(not proof["scene"]["forces"], "forces")
    free, names = system.free(proof["free"]), range(len(system.names))
    for _ in range(POINTS):
        at = system.draw()
        chart, M, V, _, N = system.near(at, free, 3)
        below = [[dot(row, x) for row in M] for x in N]
        g = [[dot(x, y) for y in below] for x in N]
        c = [[[dot(x, chart.bracket(X, Y)) for x in below] for Y in N] for X in N]
        units = [[Series.of(int(i == z)) for i in names] for z in names if z not in free]
        contained = any(chart.along(unit, x).c[0] for unit in units for x in (V, *sum(g, []), *sum(sum(c, []), [])))
        readable(not contained, "what is solved for are not velocities of symmetries")
        yield system, at, chart, g, N, c

def solved(phi, g, c):
    """c_abd + c_adb = phi_b g_ad + phi_d g_ab - 2 phi_a g_bd"""
    number = lambda x: x.c[0]
    rest = lambda a, b, d: (number(c[a][b][d]) + number(c[a][d][b]) - phi[b] * number(g[a][d]) - phi[d] * number(g[a][b])
                            + 2 * phi[a] * number(g[b][d]))
    every = range(len(g))
    return not any(rest(a, b, d) % verify.P for a in every for b in every for d in every)

def change(proof):
    over = ", ".join(name.rstrip("'") for name in proof["free"])
    return f"P = f g s, s = ({', '.join(proof['free'])}), g the metric of the kinetic energy in s", f"Chetaev's motion over ({over})"

def multiplier(proof):
    metric, angles = factors(proof, "density")
    over = [name.rstrip("'") for name in proof["free"]]
    demand(angles.keys() <= set(over), "an angle that the motion is not over")
    for system, at, chart, g, N, c in reduced(proof):
        values = system.run(at, [], [Series.of(0)] * len(system.names))
        waves = iter(values[place].plain().c[0] for place in system.texts)
        slopes = {x: y * q * invert(p) - z * p * invert(q) for (x, (y, z)), (p, q) in zip(angles.items(), zip(waves, waves))}
        traces = [solve(g, [[chart.along(X, x) for x in row] for row in g], "the metric") for X in N]
        phi = [(Series.of(metric) * sum((row[i] for i, row in enumerate(trace)), Series.of(0))).c[0] for trace in traces]
        phi = [x + Series.of(slopes.get(name, 0)).c[0] for x, name in zip(phi, over)]
        demand(solved(phi, g, c), "the motion is not Hamilton's")
    change_words, motion = change(proof)
    return [f"verified: with dtau = f dt, f = {product(metric, angles) or 1}, {change_words}, {motion} is Hamilton's, near almost every point "
            f"({POINTS} drawn points mod {verify.P})"]

def no_multiplier(proof):
    m, some = len(proof["free"]), False
    for system, at, chart, g, N, c in reduced(proof):
        C = solve(g, [[c[a][b][d] for a in range(m) for b in range(m)] for d in range(m)], "the metric")  # C[c][a, b] = C_ab^c
        over = Series.of(Fraction(-1, max(m - 1, 1)))
        phi = [over * sum((C[b][a * m + b] for b in range(m)), Series.of(0)) for a in range(m)]
        turns = (chart.along(N[a], phi[b]).c[0] - chart.along(N[b], phi[a]).c[0] for a in range(m) for b in range(a))
        some |= not solved([x.c[0] for x in phi], g, c) or any(x % verify.P for x in turns)
    demand(some, "the slopes solve their equations")
    change_words, motion = change(proof)
    return [f"verified: near almost every point there is no f(r) for which dtau = f dt, {change_words}, makes {motion} Hamilton's "
            f"(a drawn point mod {verify.P})"]

def growth(system, at, free, depth):
    """The ranks of brackets of up to 1, 2, ... fields, each with a field."""
    chart, *_, N = system.near(at, free, depth + 1)
    span, layer, ranks = Span(), N, []
    for _ in range(depth):
        layer = [Y for Y in layer if span.add({i: y.c[0] for i, y in enumerate(Y) if y.c[0]}, {}) is None]
        ranks.append(len(span.pivots))
        layer = [chart.bracket(X, Y) for X in N for Y in layer]
    return ranks

def solutions(chart, fields, rates, degree, order):
    """A basis of S_K, and the dimension of G_K."""
    m, unit = len(fields), lambda b: tuple(int(b == c) for c in range(len(fields)))
    monomials = lambda d: [tuple(x.count(b) for b in range(m)) for x in multisets(range(m), d)]
    I, plus = [x for d in range(degree, -1, -2) for x in monomials(d)], lambda a, b, sign=1: tuple(x + sign * y for x, y in zip(a, b))
    by_weight = {0: [(0,) * len(chart.weights)]}
    for w in range(1, order + 1):  # exponents of weight w, each from its last variable that occurs
        grown = ((e, i) for i, x in enumerate(chart.weights) if x <= w for e in by_weight[w - x] if not any(e[i + 1 :]))
        by_weight[w] = [(*e[:i], e[i] + 1, *e[i + 1 :]) for e, i in grown]
    def image(k, w, rest=True):
        """The part of weight w - 1 of dF/dt"""
        total = {}
        def put(J, part):
            for key, x in part.items() if part else ():
                total[J, key] = total.get((J, key), 0) + x
        for J, parts in k.items():
            for u, part in parts.items():
                for b, field in enumerate(fields):
                    for i, y in enumerate(field):
                        if u >= chart.weights[i] and (other := y.c[w - 1 - u + chart.weights[i]]) and (slope := chart.slope(part, i)):
                            put(plus(J, unit(b)), slope * other)
                for c in range(m):
                    for Q, rate in rates[c].items():
                        if u < w and J[c] and (other := rate.c[w - 1 - u]):
                            put(plus(plus(J, unit(c), -1), Q), part * (other * J[c]))
        return {at: y for at, x in total.items() if (y := x % verify.P)}
    found, loose = [{J: {0: Part({0: 1})}} for J in I], 0
    for w in range(1, order + 1):
        span, kernel = Span(), []
        new = [{J: {w: Part({sum(x << BITS * i for i, x in enumerate(e)): 1})}} for J in I for e in by_weight[w]]
        for place, k in enumerate(new + found):
            made = span.add(image(k, w), {place: 1})
            kernel += [made] if made is not None else []
            loose = len(kernel) if place == len(new) - 1 else loose
        def combined(made):
            total = {}
            for place, x in made.items():
                for J, parts in (new + found)[place].items():
                    for u, part in parts.items():
                        here = total.setdefault(J, {})
                        here[u] = (here.get(u, 0) + part * x) % verify.P
            return {J: {u: part for u, part in parts.items() if part} for J, parts in total.items()}
        found = [combined(made) for made in kernel]
    return found, loose

def bound(proof):
    system, free = mechanical(proof)
    n, m, order, weights, degree = len(system.names), len(free), proof["order"], proof["weights"], proof["degree"]
    readable(len(weights) == n and all(0 < w < 20 for w in weights) and 0 < order < 40 and 0 < degree < 10, "weights, order or degree")
    depth, chart = max(weights), Chart(weights)
    own_images(proof)
    ranks = growth(system, system.draw(), free, depth)
    theirs(proof)
    demand(ranks == growth(system, system.start(), free, depth) == [sum(w <= j + 1 for w in weights) for j in range(depth)],
           "the ranks of brackets are not those of the weights, here and near almost every point")
    demand(proof["chart"].keys() == set(system.names), "the coordinates of the chart")
    at, q, jacobian = system.start(), [], []
    verify.resize(order + 1)
    for x in system.names:
        terms = {}
        for exponents, y in proof["chart"][x]:
            readable(len(exponents) == n and max(exponents) < 40 and y < verify.P and tuple(exponents) not in terms, "a term of the chart")
            terms[tuple(exponents)] = y
        q.append(Series(chart.split(terms), at[x].first))
        demand(q[-1].c[0] == at[x].c[0], "the point of the chart")
        less = lambda e, i: (*e[:i], e[i] - 1, *e[i + 1 :])
        jacobian.append([Series(chart.split({less(e, i): y * e[i] for e, y in terms.items() if e[i]})) for i in range(n)])
    M, V, Q, N = system.local(at, q, free)
    fields = turned(solve(jacobian, turned(N), "the linear part of the chart"))
    demand(not any(any(y.c[: w - 1]) for X in fields for w, y in zip(weights, X)), "a field lowers weights by more than one")
    # g s' = X_a(M)(v, v)/2 - X_a(V) + N_a'(Q - d/dt (M N) s)
    momenta = [[dot(row, x) for row in M] for x in N]
    g, half, pairs = [[dot(x, y) for y in momenta] for x in N], Series.of(Fraction(1, 2)), [*multisets(range(m), 2)]
    def right(a):
        slope = [[chart.along(fields[a], x) for x in row] for row in M]
        part = lambda b, c: half * dot(N[b], [dot(row, N[c]) for row in slope]) + dot(N[a], [chart.along(fields[b], x) for x in momenta[c]]) * -1
        return [*(part(b, c) if b == c else part(b, c) + part(c, b) for b, c in pairs), dot(N[a], Q) + chart.along(fields[a], V) * -1]
    rates = solve(g, [right(a) for a in range(m)], "the metric on the free velocities")
    squares = [*(tuple((b, c).count(a) for a in range(m)) for b, c in pairs), (0,) * m]
    found, loose = solutions(chart, fields, [dict(zip(squares, row)) for row in rates], degree, order)
    demand(not loose, "terms of the last weight are free")
    demand(len(found) == proof["bound"], f"the bound, which is {len(found)}")
    degrees = f"of degree {degree} in the velocities (terms of degree {', '.join(map(str, range(degree, -1, -2)))})"
    words = f"at most {len(found)} linearly independent integrals are polynomials {degrees}"
    if degree == 1:
        words = f"{f'at most {len(found)} linearly independent integrals are' if found else 'no integral is'} linear in the velocities"
    if (degree, len(found)) == (2, 2) and not proof["scene"]["forces"]:
        words = "no integral but energy and constants is quadratic in the velocities (terms of degree 2, 0)"
    return [f"verified: near almost every point {words}, with analytic functions of q, local ones included, of Chetaev's motion "
            f"(order {order} mod {verify.P})"]

def velocities(system, at):
    """Drawn ones with f = 0: one where f is affine in v, both on a drawn line where a single f is quadratic."""
    p, drawn, degrees = verify.P, lambda: [secrets.randbelow(verify.P) for _ in system.names], system.formulas.degrees(system.rates)
    def f(v):
        values = system.run(at, [], [Series([x % p]) for x in v])
        return [values[place].plain().c[0] for place in system.f]
    if all(degrees[place] <= 1 for place in system.f):
        v, ways = drawn(), [drawn() for _ in system.f]  # f = 0 at v + sum x_k (way k)
        here = f(v)
        matrix = turned([[Series([(x - y) % p]) for x, y in zip(f([*map(int.__add__, v, way)]), here)] for way in ways])
        found = solve(matrix, [[Series([-x % p])] for x in here], "the constraints are not independent")
        return [[(x + sum(row[0].c[0] * y for row, y in zip(found, column))) % p for x, *column in zip(v, *ways)]]
    readable(len(system.f) == 1, "several constraints that are not affine in v")
    for _ in range(200):
        u, way = drawn(), drawn()
        on = lambda k: [(x + k * y) % p for x, y in zip(u, way)]
        c, plus, minus, twice = (f(on(k))[0] for k in (0, 1, -1, 2))
        a, b = (plus + minus - 2 * c) * invert(2) % p, (plus - minus) * invert(2) % p
        readable((4 * a + 2 * b + c - twice) % p == 0, "a constraint that is neither affine nor quadratic in v")
        if a and pow(square := (b * b - 4 * a * c) % p, p // 2, p) == 1:
            return [on((sign * root(square, p) - b) * invert(2 * a)) for sign in (1, -1)]
    readable(False, "a constraint without regular points")

def integral(proof):
    system = System(proof["scene"], proof["integral"])
    names, values = system.names, []
    used = system.names_in(system.texts) - {*names, *system.rates, "t"}
    demand(used <= proof["scene"]["parameters"].keys(), "a name in the integral")
    own_images(proof)
    for _ in range(POINTS):
        at = system.draw()
        for v in velocities(system, at):
            acceleration = [row[0].c[0] for row in system.jets(at, v)[0][: len(names)]]
            verify.resize(2)
            q = [Series([at[x].c[0], y], at[x].first) for x, y in zip(names, v)]
            moving = system.run(at, q, [Series([x, a]) for x, a in zip(v, acceleration)], t=Series([at["t"].c[0], 1], at["t"].first))
            demand(not any(any(moving[place].c) for place in system.f), "the constraints along the motion")
            F = moving[system.texts[0]].plain()
            demand(F.c[1] == 0, "the integral is not constant along Chetaev's motions")
            values.append(F.c[0])
            verify.resize(1)
    demand(len(set(values)) > 1, "the integral is a constant where f = 0")
    known = ", ".join(f"{name} = {proof['scene']['parameters'][name]}" for name in sorted(used))
    return [f"verified: {proof['integral']}{' with ' * bool(known) + known} is constant along Chetaev's motions, near almost every point "
            f"({POINTS} drawn points mod {verify.P})"]

CLAIMS = {
    "no measure": (no_measure, {"free": MANY(WORD), "brackets": MANY(PAIR), "rows": MANY(WHOLE), "minor": WHOLE}),
    "measure": (measure, {"free": MANY(WORD), "density": verify.EXACTLY({"metric": WORD, "angles": NAMED(lambda x: MANY(WORD)(x) and len(x) == 2)})}),
    "multiplier": (multiplier, {"free": MANY(WORD), "density": verify.EXACTLY({"metric": WORD, "angles": NAMED(lambda x: MANY(WORD)(x) and len(x) == 2)})}),
    "no multiplier": (no_multiplier, {"free": MANY(WORD)}),
    "bound": (bound, {"degree": WHOLE, "free": MANY(WORD), "weights": MANY(WHOLE), "order": WHOLE, "bound": WHOLE,
                      "chart": NAMED(MANY(lambda x: type(x) is list and len(x) == 2 and MANY(WHOLE)(x[0]) and WHOLE(x[1])))}),
    "integral": (integral, {"integral": WORD}),
}

def verified(proof):
    """What is verified, in lines, and what the scene file is held against."""
    readable(type(proof) is dict and proof.get("schema") == "deltaq/integrals-certificate/1", "the schema")
    readable(type(proof.get("kind")) is str and proof["kind"] in CLAIMS, "the kind")
    claim, kinds = CLAIMS[proof["kind"]]
    verify.of_kind(proof, {"kind": WORD} | kinds)
    demand(not proof["scene"]["velocities"], "velocities of a point")
    lines = claim(proof)
    if proof["kind"] in ("no measure", "bound"):
        lines.append("point: " + ", ".join(f"{x} = {proof['scene']['positions'][x]}" for x in proof["scene"]["coordinates"]))
    # the file is held against the scene at a drawn point, where both are the same to all orders
    own_images(proof)
    verify.resize(1)
    system = System(proof["scene"])
    if system.box:
        lines = [line.replace("near almost every point", "near almost every point on the branch of the point of the certificate") for line in lines]
    scene = system.elsewhere()
    at = verify.started(scene)
    motion = {x: [at[x].c[0], secrets.randbelow(verify.P)] for x in scene["coordinates"]}
    return lines, proof | {"scene": scene, "point": proof["scene"], "order": 5, "almost_every_start": True, "completed": [], "motion": motion}

def main(*files):
    return verify.answered(verified, *files)
