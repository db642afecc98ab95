"""Error over time as SVG, legible on dark and light pages."""

import math

COLOURS = {"deltaq": "#0072B2", "heyoka": "#D55E00", "scipy": "#009E73", "casadi": "#CC79A7"}
# of several rows of one tool: outlines of marks about (0, 0)
MARKS = ("", "m-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z", "m-4-4h8v8h-8z")
# forms of the equations, where a tool has several: what follows the tool in the name of a row, and dashes
FORMS = {"": "", "reduced by hand": "", "multipliers": "7 4"}
LEFT, WIDTH, HEIGHT, LINE, COLUMN = 66, 636, 340, 18, 325
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


def named(row):
    """A row as the tool and the form of its equations."""
    name, _, form = row.rpartition(", ")
    return (name, form) if form in FORMS else (row, "")


def axis(values):
    """From the logarithms of positive values to parts of an axis, and the powers of ten on it."""
    low, high = math.log10(min(values)) - 0.1, math.log10(max(values)) + 0.1
    powers = range(math.ceil(low), math.floor(high) + 1)
    return lambda x: (math.log10(x) - low) / (high - low), powers[:: 1 + len(powers) // 8]


def picture(problem, rungs):
    """The rungs of a problem, as they are kept."""
    found = curves(rungs)
    x_of, x_ticks = axis([x for _, points in found.values() for x, _ in points])
    y_of, y_ticks = axis([y for _, points in found.values() for _, y in points])
    place = lambda x, y: (round(x * WIDTH, 1), round((1 - y) * HEIGHT, 1))
    # one entry of the legend per tool, and one per form of several
    entries, body, used = {}, [], {}

    def draw(tool, nth, dash, at):
        stroke = f'fill="none" stroke="{COLOURS.get(tool, "currentColor")}" stroke-width="{4 if tool == "deltaq" else 2.4}"'
        line = f'<path d="M{"L".join(f"{x} {y}" for x, y in at)}" {stroke} stroke-dasharray="{dash}"/>'
        return line + "".join(f'<path d="M{x} {y}{MARKS[nth]}" fill="{COLOURS[tool]}"/>' for x, y in at if nth)

    several = any(form == "multipliers" for _, form in map(named, found))
    for row, (tool, points) in found.items():
        name, form = named(row) if several else (row, "")
        nth = used.setdefault(tool, {}).setdefault(name, len(used[tool]))
        body.append(draw(tool, nth, FORMS[form], [place(x_of(x), y_of(y)) for x, y in points]))
        entries[name] = (tool, nth, "")
    entries |= {form: (None, 0, dash) for form, dash in FORMS.items() if several and form}
    legend = []
    for i, (name, entry) in enumerate(entries.items()):
        at = f"translate({LEFT + i % 2 * COLUMN} {40 + i // 2 * LINE})"
        legend.append(f'<g transform="{at}">{draw(*entry, [(0, 0), (20, 0), (40, 0)])}<text x="50" y="4.5">{name}</text></g>')
    top = 40 + (len(entries) + 1) // 2 * LINE
    ticks = []
    for k in x_ticks:
        x, _ = place(x_of(10.0**k), 0)
        ticks.append(f'<path d="M{x} 0v{HEIGHT}"/><text x="{x}" y="{HEIGHT + 18}" text-anchor="middle">10{str(k).translate(SUPERSCRIPT)}</text>')
    for k in y_ticks:
        _, y = place(0, y_of(10.0**k))
        ticks.append(f'<path d="M0 {y}h{WIDTH}"/><text x="-9" y="{y + 4}" text-anchor="end">10{str(k).translate(SUPERSCRIPT)}</text>')
    title, total = f"{problem}: error over time", top + HEIGHT + 48
    return f"""<svg xmlns="http://www.w3.org/2000/svg" width="720" height="{total}" viewBox="0 0 720 {total}" role="img" aria-label="{title}" \
class="picture" color="#7a7f86" fill="currentColor" font-size="13" font-family="system-ui,-apple-system,'Segoe UI',Helvetica,Arial,sans-serif">
<title>{title}</title>
<desc>Largest error over the time of one run. Curves: {"; ".join(found)}.</desc>
<style>.grid path{{fill:none;stroke:currentColor;stroke-opacity:.25}}@media (prefers-color-scheme:light){{.picture{{color:#505860}}}}\
@media (prefers-color-scheme:dark){{.picture{{color:#a9b1ba}}}}</style>
<text x="{LEFT}" y="20" font-size="15" font-weight="600">{title}</text>
{chr(10).join(legend)}
<g transform="translate({LEFT} {top})">
<g class="grid" font-size="12">{chr(10).join(ticks)}<path d="M0 0h{WIDTH}v{HEIGHT}h-{WIDTH}z"/></g>
<text x="{WIDTH / 2}" y="{HEIGHT + 38}" text-anchor="middle">time of one run, with its trajectory (ms)</text>
<text transform="translate(-48 {HEIGHT / 2}) rotate(-90)" text-anchor="middle">largest error (m √kg)</text>
{chr(10).join(body)}
</g>
</svg>
"""
