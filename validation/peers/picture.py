"""Work–precision diagrams as SVG, legible on dark and light pages: the fastest variant of each tool."""

import math

COLOURS = {"deltaq": "#0072B2", "heyoka": "#D55E00", "scipy": "#009E73", "casadi": "#CC79A7"}
# the error at which times are compared
TARGET = 1e-10
LEFT, WIDTH, HEIGHT, LINE = 66, 636, 340, 18
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def curves(rungs):
    """Row to (tool, points): of several methods in a row, what is not worse than another one in both."""
    found = {}
    for rung in sorted(rungs, key=lambda rung: rung["seconds"]):
        if rung["task"] == "trajectory" and rung["error"] > 0:
            _, points = found.setdefault(rung["row"], (rung["entrant"][0], []))
            if not points or rung["error"] < points[-1][1]:
                points.append((1e3 * rung["seconds"], rung["error"]))
    return {row: found[row] for row in dict.fromkeys(rung["row"] for rung in rungs) if row in found}


def fastest(points):
    """The least time to the error that is compared."""
    return min((time for time, error in points if error <= TARGET), default=math.inf)


def drawn(found):
    """The fastest row of each tool, ours first, and how many times as long as ours it takes."""
    best = {}
    for row, (tool, points) in found.items():
        if tool not in best or fastest(points) < fastest(best[tool][1]):
            best[tool] = (row, points)
    ours = fastest(best["deltaq"][1]) if "deltaq" in best else math.nan
    return {row: (tool, points, fastest(points) / ours) for tool, (row, points) in sorted(best.items(), key=lambda item: item[0] != "deltaq")}


def named(row):
    """A row as the tool with its variant in parentheses."""
    name, _, variant = row.partition(", ")
    return f"{name} ({variant})" if variant else name


def headline(problem, shown):
    """What the picture says."""
    known = sorted((ratio, row) for row, (tool, _, ratio) in shown.items() if tool != "deltaq" and math.isfinite(ratio))
    if not known:
        return f"{problem}: error against time of one run"
    return f"{problem}: to {TARGET:.0e} " + ", ".join(f"{named(row)} {ratio:.2g} ×" for ratio, row in known) + " the time of deltaq"


def lines(text, limit=66):
    """Words in lines of at most so many letters."""
    found = [""]
    for word in text.split():
        if len(found[-1]) + len(word) >= limit:
            found.append("")
        found[-1] = f"{found[-1]} {word}".strip()
    return found


def axis(values):
    """From the logarithms of positive values to parts of an axis, and the powers of ten on it."""
    low, high = math.log10(min(values)) - 0.1, math.log10(max(values)) + 0.1
    powers = range(math.ceil(low), math.floor(high) + 1)
    return lambda x: (math.log10(x) - low) / (high - low), powers[:: 1 + len(powers) // 8]


def picture(problem, rungs):
    """The rungs of a problem, as they are kept."""
    shown = drawn(curves(rungs))
    x_of, x_ticks = axis([x for _, points, _ in shown.values() for x, _ in points])
    y_of, y_ticks = axis([y for _, points, _ in shown.values() for _, y in points] + [TARGET])
    place = lambda x, y: (round(x * WIDTH, 1), round((1 - y) * HEIGHT, 1))
    body, taken = [], []
    for row, (tool, points, _) in shown.items():
        at = [place(x_of(x), y_of(y)) for x, y in points]
        width, colour = (4 if tool == "deltaq" else 2.4), COLOURS.get(tool, "currentColor")
        body.append(f'<path d="M{"L".join(f"{x} {y}" for x, y in at)}" fill="none" stroke="{colour}" stroke-width="{width}"/>')
        body += [f'<circle cx="{x}" cy="{y}" r="3.5" fill="{colour}"/>' for x, y in at]
        # a name beside the upper end of its curve, below the names that are there already
        x, y = at[0]
        anchor, x = ("end", x - 8) if x > WIDTH - 7.5 * len(row) else ("start", x + 8)
        y = max(y + 4, 14)
        while any(abs(y - other) < LINE and abs(x - beside) < 190 for beside, other in taken):
            y += LINE
        taken.append((x, y))
        body.append(f'<text x="{x}" y="{y}" text-anchor="{anchor}" font-weight="600" fill="{colour}">{row}</text>')
    ticks = []
    for k in x_ticks:
        x, _ = place(x_of(10.0**k), 0)
        ticks.append(f'<path d="M{x} 0v{HEIGHT}"/><text x="{x}" y="{HEIGHT + 18}" text-anchor="middle">10{str(k).translate(SUPERSCRIPT)}</text>')
    for k in y_ticks:
        _, y = place(0, y_of(10.0**k))
        ticks.append(f'<path d="M0 {y}h{WIDTH}"/><text x="-9" y="{y + 4}" text-anchor="end">10{str(k).translate(SUPERSCRIPT)}</text>')
    _, y = place(0, y_of(TARGET))
    ticks.append(f'<path d="M0 {y}h{WIDTH}" stroke-dasharray="7 4" style="stroke-opacity:.9"/>')
    title = headline(problem, shown)
    head = "\n".join(f'<text x="{LEFT}" y="{20 * (i + 1)}" font-size="15" font-weight="600">{line}</text>' for i, line in enumerate(lines(title)))
    top = 20 * len(lines(title)) + 14
    total = top + HEIGHT + 48
    return f"""<svg xmlns="http://www.w3.org/2000/svg" width="720" height="{total}" viewBox="0 0 720 {total}" role="img" aria-label="{title}" \
class="picture" color="#7a7f86" fill="currentColor" font-size="13" font-family="system-ui,-apple-system,'Segoe UI',Helvetica,Arial,sans-serif">
<title>{title}</title>
<desc>Largest error against the time of one run, the fastest variant of each tool; dashed: the error that is compared. Curves: {"; ".join(shown)}.</desc>
<style>.grid path{{fill:none;stroke:currentColor;stroke-opacity:.25}}@media (prefers-color-scheme:light){{.picture{{color:#505860}}}}\
@media (prefers-color-scheme:dark){{.picture{{color:#a9b1ba}}}}</style>
{head}
<g transform="translate({LEFT} {top})">
<g class="grid" font-size="12">{chr(10).join(ticks)}<path d="M0 0h{WIDTH}v{HEIGHT}h-{WIDTH}z"/></g>
<text x="{WIDTH / 2}" y="{HEIGHT + 38}" text-anchor="middle">time of one run, with its trajectory (ms)</text>
<text transform="translate(-48 {HEIGHT / 2}) rotate(-90)" text-anchor="middle">largest error (m √kg)</text>
{chr(10).join(body)}
</g>
</svg>
"""
