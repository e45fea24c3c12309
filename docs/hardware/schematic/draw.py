"""A sheet as a picture: each part with its pins, each pin with the name of its net; equal names are connected."""

from html import escape

PITCH, COLUMN, COLUMNS = 15, 360, 4
MIDDLE, WIDTH = COLUMN // 2, COLUMN * COLUMNS
COLOURS = {"V24": "#b00020", "V12": "#b05a00", "V5": "#8a6d00", "V3": "#006d5b", "GND": "#555"}


def _text(x, y, words, anchor="start", size=10, colour="#111", bold=False):
    weight = ' font-weight="bold"' if bold else ""
    return f'<text x="{x}" y="{y}" text-anchor="{anchor}" font-size="{size}" fill="{colour}"{weight}>{escape(words)}</text>'


def _symbol(ref, x, y):
    """Between x and x + 60 at height y."""
    line = f'<path d="M{x} {y}h14M{x + 46} {y}h14" stroke="#111"/>'
    if ref[0] == "C":
        return f'<path d="M{x} {y}h27M{x + 33} {y}h27M{x + 27} {y - 8}v16M{x + 33} {y - 8}v16" stroke="#111" stroke-width="1.4" fill="none"/>'
    if ref[0] == "D":
        return line + f'<path d="M{x + 14} {y}h32M{x + 22} {y - 7}v14M{x + 22} {y}l16 -7v14z" stroke="#111" fill="none"/>'
    if ref[0] == "F":
        return line + f'<path d="M{x + 14} {y - 4}h32v8h-32zM{x + 14} {y}h32" stroke="#111" fill="none"/>'
    return line + f'<rect x="{x + 14}" y="{y - 5}" width="32" height="10" stroke="#111" fill="none"/>'


def _part(ref, pins, fields, x, y):
    """Markup and height."""
    label = f"{ref}  {fields['what']}" if len(pins) < 3 else f"{ref}  {fields['number']}"
    out = [_text(x + MIDDLE, y + 10, label, "middle", bold=True)]
    if len(pins) == 2:
        out.append(_symbol(ref, x + MIDDLE - 30, y + 24))
        for (_, _, net), at, anchor in zip(pins, (x + MIDDLE - 35, x + MIDDLE + 35), ("end", "start")):
            out.append(_text(at, y + 28, net, anchor, colour=COLOURS.get(net, "#123a8c")))
        return out, 44
    pins = [pin for pin in pins if pin[2]]
    half = (len(pins) + 1) // 2
    height = half * PITCH + 8
    out.append(f'<rect x="{x + MIDDLE - 50}" y="{y + 16}" width="100" height="{height}" fill="#fbf7ea" stroke="#111"/>')
    for index, (number, name, net) in enumerate(pins):
        left, row = index < half, index % half
        at, edge = y + 16 + PITCH * (row + 0.8), x + MIDDLE + (-50 if left else 50)
        out.append(f'<path d="M{edge} {at - 3}h{-10 if left else 10}" stroke="#111"/>')
        inside = f"{number} {name}" if left and number != name else f"{name} {number}" if number != name else name
        out.append(_text(edge + (4 if left else -4), at, inside, "start" if left else "end", 8))
        out.append(_text(edge + (-13 if left else 13), at, net, "end" if left else "start", colour=COLOURS.get(net, "#123a8c")))
    return out, height + 30


def sheet(title, refs, netlist, kinds):
    pins = {ref: [(n, name, net) for r, n, name, net in netlist if r == ref] for ref in refs}
    heights, out = [36] * COLUMNS, [_text(20, 22, title, size=15, bold=True)]
    for ref in sorted(refs, key=lambda ref: -len(pins[ref])):
        column = heights.index(min(heights))
        markup, height = _part(ref, pins[ref], kinds[ref], column * COLUMN, heights[column])
        out += markup
        heights[column] += height
    tall = max(heights) + 12
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{tall:g}" viewBox="0 0 {WIDTH} {tall:g}" font-family="sans-serif">'
            f'<rect width="100%" height="100%" fill="white"/>\n' + "\n".join(out) + "\n</svg>\n")
