"""Electrical rules beyond those of SKiDL (pins left open, outputs against outputs, supplies that nobody feeds)."""

import csv

from parts import HIGHEST

# Share of its rated voltage that a part may see.
DERATING = 0.8
# Where the board ends: nets of connectors that need an arrester, and those that the driver's own diodes tie to rail and ground.
CLAMPED = {"COIL1+", "COIL1-", "COIL2+", "COIL2-", "COIL1_NODE", "COIL2_NODE"}
# Parts without which a rule must be violated: each is taken away in turn, to see that its rule sees.
GUARDED = ["F1", "D6", "C1", "R50", "R51", "D20", "D21", "D30", "D31", "D32", "R62", "R66", "R72", "R76", "F2", "F3", "U9", "R82", "JP1",
           "R12", "Q5", "D61", "D62", "C80", "R10", "C17", "TP1", "R60", "D60", "R4", "R5", "C8"]


def violations(netlist, kinds):
    found = []
    nets, of = {}, {}
    for ref, pin, _, net in netlist:
        if net:
            nets.setdefault(net, []).append((ref, pin))
            of.setdefault(ref, {})[pin] = net
    refs = set(of)

    def between(a, b, prefix):
        return [r for r in refs if r.startswith(prefix) and set(of[r].values()) == {a, b}]

    def need(what, ok):
        if not ok:
            found.append(f"rule: {what}")

    for net, pins in nets.items():
        need(f"{net} has one pin only, of {pins[0][0]}", len(pins) > 1)
    # Voltage: of each part with two ends across supplies, and of chips by their highest supply.
    for ref, pins in of.items():
        volts = float(kinds[ref].get("volts") or 0)
        highest = max((HIGHEST.get(net, 0.0) for net in pins.values()), default=0.0)
        share = 1.0 if ref.startswith("U") else DERATING
        need(f"{ref} stands {volts} V and sees {highest} V", not volts or highest <= share * volts)
    # Supply.
    need("a fuse is between input and everything", {ref for ref, _ in nets["V24_IN"]} == {"J5", "F1"})
    need("reverse polarity is blocked", any(kinds[r]["number"].startswith("SQD50P06") for r, _ in nets["V24_FUSED"] if r in refs))
    need("the 24 V rail has clamp and capacitor", any(kinds[r]["number"] == "SMBJ26A" for r in between("V24", "GND", "D")) and
         any("1000" in kinds[r]["what"] for r in between("V24", "GND", "C")))
    # The measured supply, and a capacitor that the converter's sampling draws from.
    need("the supply's divider is of 100 kΩ and 10 kΩ, with a capacitor",
         any(kinds[r]["what"].startswith("100K") for r in between("V24", "SUPPLY", "R")) and
         any(kinds[r]["what"].startswith("10K") for r in between("SUPPLY", "GND", "R")) and between("SUPPLY", "GND", "C"))
    # Each chip's supply pins have a capacitor each.
    chips = [(r, n) for r, pins in of.items() if r.startswith("U") for n in {net for pin, net in pins.items()} & {"V3", "VDDA", "V12", "V5"}]
    extra = {"V3": sum(1 for pin, net in of["U1"].items() if net == "V3" and pin != "1") - 1}
    for rail in {n for _, n in chips}:
        wanted = sum(1 for r, n in chips if n == rail) + extra.get(rail, 0) - (rail == "V3")  # The regulator's own is another's input.
        have = len(between(rail, "GND", "C"))
        need(f"{rail} has {have} capacitors, {wanted} wanted", have >= wanted)
    # Encoder and cables.
    for a, b in [("A+", "A-"), ("B+", "B-")]:
        need(f"{a}, {b}: 120 Ω", any(kinds[r]["what"].startswith("120R") for r in between(a, b, "R")))
    for ref in refs:
        if ref.startswith("J"):
            for net in of[ref].values():
                if net not in HIGHEST and net not in CLAMPED:
                    arrested = [r for r, _ in nets[net] if r.startswith("D") and kinds[r]["number"].startswith(("TPD", "SM712", "PRTR"))]
                    need(f"{net} leaves the board at {ref} without an arrester", arrested)
    # Coils: released without a processor; stopped by fuse and comparator; their current has its ways.
    for n in (1, 2):
        for net in (f"LOW{n}", f"HIGH{n}"):
            need(f"{net} is pulled down", any(kinds[r]["what"].startswith("10K") for r in between(net, "GND", "R")))
        need(f"coil {n} has a fuse", between("V24", f"FUSED{n}", "F"))
        need(f"gate {n}: resistor and Zener diode to the source", between(f"FUSED{n}", f"HIGH_GATE{n}", "R") and
             between(f"FUSED{n}", f"HIGH_GATE{n}", "D"))
        for kathode, anode in [(f"COIL{n}_NODE", "GND"), (f"FUSED{n}", f"COIL{n}-")]:
            need(f"diode from {anode} to {kathode}",
                 any(of[r].get("1") == kathode and kinds[r]["number"].startswith("SS56") for r in between(kathode, anode, "D")))
    need("comparators reach the break input", ("U1", "22") in nets["BREAK"] and
         all((r, p) in nets["BREAK"] for r, p in [("U9", "1"), ("U9", "7")]) and between("V3", "BREAK", "R"))
    # Processor.
    need("BOOT0 is low", between("BOOT0", "GND", "R"))
    need("jumper and its resistor", between("COMMISSION", "GND", "JP") and between("V3", "COMMISSION", "R"))
    for net in ("V24", "V12", "V5", "V3", "GND", "BREAK", "AMPLIFIED1", "AMPLIFIED2"):
        need(f"{net} has a test point", any(r.startswith("TP") for r, _ in nets.get(net, [])))
    return found


def blind(netlist, kinds):
    """Parts whose absence no rule sees, though it should."""
    return [f"rules: nobody misses {ref}" for ref in GUARDED if not violations([row for row in netlist if row[0] != ref], kinds)]


def parts_list(kinds, path):
    lines = {}
    for ref, fields in kinds.items():
        lines.setdefault((fields["maker"], fields["number"], fields["what"]), []).append(ref)
    with open(path, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("parts", "count", "maker", "number", "what"))
        out.writerows((" ".join(refs), len(refs), *about) for about, refs in lines.items())
