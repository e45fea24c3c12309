"""The schematic as code: `python board.py FOLDER` checks its electrical rules and writes netlist, parts list and sheets into FOLDER."""

import builtins
import csv
import pathlib
import sys

import parts as p
import skidl
from skidl import POWER, Net

HERE = pathlib.Path(__file__).parent
PINS = list(csv.DictReader(open(HERE / "pins.csv", encoding="utf-8")))
SHEET = {}
_nets = {}
# SKiDL puts these among the built-in names.
NC, default_circuit = builtins.NC, builtins.default_circuit


def net(name):
    if name not in _nets:
        _nets[name] = Net(name)
        # Rails that come through passive parts: the tool cannot see that they are fed.
        if name in ("GND", "V24", "VDDA", "LINK_SUPPLY", "LINK_GND", "V24_IN"):
            _nets[name].drive = POWER
    return _nets[name]


def place(sheet, ref, template, **pins):
    """A part on a sheet; `pins`: p<number> = net."""
    part = template(ref=ref)
    SHEET[ref] = sheet
    for key, name in pins.items():
        net(name).connect(part[key[1:]])
    for pin in part.pins:
        if pin.func == p.TYPES["N"]:
            NC.connect(pin)
    return part


def two(sheet, ref, template, a, b):
    return place(sheet, ref, template, p1=a, p2=b)


def direction(function):
    """Type of a processor's pin that is used so."""
    if function.startswith(("output", "TIM8 CH", "USART1 TX")) or " SCK" in function or " MOSI" in function:
        return "O"
    return {"SWDIO": "B", "oscillator": "P"}.get(function, "I")


def supply():
    s = "supply"
    place(s, "J5", p.header(2, "Phoenix Contact", "1757242", "24 V"), p1="V24_IN", p2="GND")
    two(s, "F1", p.FUSE_INPUT, "V24_IN", "V24_FUSED")
    place(s, "Q5", p.POLARITY, p1="POLARITY", p2="V24_FUSED", p3="V24")
    two(s, "R1", p.resistor("10K"), "POLARITY", "GND")
    two(s, "D5", p.ZENER, "V24", "POLARITY")
    two(s, "D6", p.CLAMP, "V24", "GND")
    two(s, "C1", p.C1000U, "V24", "GND")
    two(s, "C2", p.C1U, "V24", "GND")
    place(s, "U2", p.LDO_12, p1="V12", p2="V12_FB", p4="GND", p5="V24", p8="V24")
    two(s, "R2", p.resistor("93K1"), "V12", "V12_FB")
    two(s, "R3", p.resistor("10K"), "V12_FB", "GND")
    two(s, "C3", p.C10U, "V12", "GND")
    place(s, "U3", p.BUCK_5, p1="V24", p2="GND", p3="V5")
    two(s, "C4", p.C1U, "V24", "GND")
    two(s, "C5", p.C470U, "V5", "GND")
    place(s, "U4", p.LDO_3, p1="GND", p2="V3", p3="V5")
    two(s, "C6", p.C10U, "V5", "GND")
    two(s, "C7", p.C10U, "V3", "GND")
    # 36.3 V at the end of the converter's scale; below 3.3 V at its pin with the clamp at work.
    two(s, "R4", p.resistor("100K"), "V24", "SUPPLY")
    two(s, "R5", p.resistor("10K"), "SUPPLY", "GND")
    two(s, "C8", p.C10N, "SUPPLY", "GND")
    for ref, name in [("TP1", "V24"), ("TP2", "V12"), ("TP3", "V5"), ("TP4", "V3"), ("TP5", "GND")]:
        place(s, ref, p.TEST_POINT, p1=name)


def processor():
    s = "processor"
    used = {f"p{row['number']}": row["net"] for row in PINS}
    fixed = dict(p1="V3", p12="GND", p13="VDDA", p18="GND", p19="V3", p32="V3", p48="V3", p63="GND", p64="V3", p7="NRST", p31="VCAP1",
                 p47="VCAP2", p60="BOOT0")
    place(s, "U1", p.processor({int(row["number"]): f"{row['pin']} {direction(row['function'])}" for row in PINS}), **used, **fixed)
    for ref, rail in [("C10", "V3"), ("C11", "V3"), ("C12", "V3"), ("C13", "V3"), ("C14", "VDDA")]:
        two(s, ref, p.C100N, rail, "GND")
    two(s, "C15", p.C10U, "V3", "GND")
    two(s, "L1", p.FERRITE, "V3", "VDDA")
    two(s, "C16", p.C2U2, "VDDA", "GND")
    two(s, "C17", p.C2U2, "VCAP1", "GND")
    two(s, "C18", p.C2U2, "VCAP2", "GND")
    two(s, "Y1", p.CRYSTAL, "CRYSTAL_IN", "CRYSTAL_OUT")
    two(s, "C19", p.C18P, "CRYSTAL_IN", "GND")
    two(s, "C20", p.C18P, "CRYSTAL_OUT", "GND")
    two(s, "R10", p.resistor("10K"), "BOOT0", "GND")
    two(s, "C21", p.C100N, "NRST", "GND")
    two(s, "R11", p.resistor("680R"), "V3", "LIGHT_A")
    place(s, "D10", p.LIGHT, p1="LIGHT", p2="LIGHT_A")
    two(s, "R12", p.resistor("10K"), "V3", "COMMISSION")
    two(s, "JP1", p.JUMPER, "COMMISSION", "GND")
    place(s, "J7", p.header(5, "Samtec", "TSW-105-07-G-S", "probe"), p1="V3", p2="SWDIO", p3="GND", p4="SWCLK", p5="NRST")
    place(s, "D11", p.ESD_4, p1="SWDIO", p2="SWCLK", p3="GND", p4="NRST", p5="COMMISSION")
    place(s, "TP6", p.TEST_POINT, p1="NRST")
    place(s, "TP7", p.TEST_POINT, p1="BREAK")


def sensors():
    for first, where, connector, chip, esd in [(30, "BLOCK", "J1", "U20", "D20"), (40, "GROUND", "J2", "U21", "D21")]:
        s = "sensors"
        wires = ["SCK", "MOSI", "MISO", "CS"]
        for offset, wire in enumerate(wires):
            two(s, f"R{first + offset}", p.resistor("33R"), f"{where}_{wire}", f"{where}_{wire}_WIRE")
        w = {wire: f"{where}_{wire}_WIRE" for wire in wires}
        place(s, connector, p.header(6, "JST", "B6B-XH-A", f"{where.lower()} sensor"), p1="V3", p2="GND", p3=w["SCK"], p4=w["MOSI"],
              p5=w["MISO"], p6=w["CS"])
        place(s, esd, p.ESD_4, p1=w["SCK"], p2=w["MOSI"], p3="GND", p4=w["MISO"], p5=w["CS"])
        place(s, chip, p.SENSOR, p1=w["MISO"], p5="V3", p6="GND", p8="V3", p12=w["CS"], p13=w["SCK"], p14=w["MOSI"])
        two(s, f"C{first}", p.C2U2, "V3", "GND")
        two(s, f"C{first + 1}", p.C100N, "V3", "GND")
        two(s, f"C{first + 2}", p.C100N, "V3", "GND")


def encoder_and_link():
    s = "encoder and link"
    place(s, "J3", p.header(6, "JST", "B6B-XH-A", "encoder"), p1="ENCODER_5V", p2="GND", p3="A+", p4="A-", p5="B+", p6="B-")
    two(s, "F4", p.FUSE_ENCODER, "V5", "ENCODER_5V")
    two(s, "C50", p.C100N, "ENCODER_5V", "GND")
    two(s, "R50", p.resistor("120R"), "A+", "A-")
    two(s, "R51", p.resistor("120R"), "B+", "B-")
    place(s, "D30", p.ESD_422, p1="A+", p2="A-", p3="GND")
    place(s, "D31", p.ESD_422, p1="B+", p2="B-", p3="GND")
    place(s, "U5", p.RECEIVER, p1="A-", p2="A+", p3="ENCODER_A", p4="V3", p5="ENCODER_B", p6="B+", p7="B-", p8="GND", p12="GND", p16="V3")
    two(s, "C51", p.C100N, "V3", "GND")
    place(s, "U6", p.ISOLATOR, p1="V3", p2="LINK_RX", p3="LINK_TX", p4="GND", p5="LINK_GND", p6="LINK_OUT", p7="LINK_IN", p8="LINK_SUPPLY")
    two(s, "C52", p.C100N, "V3", "GND")
    two(s, "C53", p.C100N, "LINK_SUPPLY", "LINK_GND")
    two(s, "R52", p.resistor("100R"), "LINK_OUT", "LINK_OUT_WIRE")
    two(s, "R53", p.resistor("100R"), "LINK_IN", "LINK_IN_WIRE")
    place(s, "D32", p.ESD_2, p1="LINK_GND", p2="LINK_OUT_WIRE", p3="LINK_IN_WIRE", p4="LINK_SUPPLY")
    place(s, "J6", p.header(4, "JST", "B4B-XH-A", "serial, isolated"), p1="LINK_SUPPLY", p2="LINK_GND", p3="LINK_OUT_WIRE", p4="LINK_IN_WIRE")


def coils():
    for n, first in [(1, 60), (2, 70)]:
        s = f"coil {n}"
        two(s, f"F{n + 1}", p.FUSE_COIL, "V24", f"FUSED{n}")
        place(s, f"Q{first}", p.HIGH_SIDE, p1=f"HIGH_GATE{n}", p2=f"COIL{n}_NODE", p3=f"FUSED{n}")
        two(s, f"R{first}", p.resistor("10K"), f"FUSED{n}", f"HIGH_GATE{n}")
        two(s, f"D{first}", p.ZENER, f"FUSED{n}", f"HIGH_GATE{n}")
        two(s, f"R{first + 1}", p.resistor("2K2", "RC1206FR-072K2L", "1 %, 0.25 W"), f"HIGH_GATE{n}", f"HIGH_PULL{n}")
        place(s, f"Q{first + 1}", p.PULLER, p1=f"HIGH{n}", p2="GND", p3=f"HIGH_PULL{n}")
        two(s, f"R{first + 2}", p.resistor("10K"), f"HIGH{n}", "GND")
        two(s, f"D{first + 1}", p.SCHOTTKY, f"COIL{n}_NODE", "GND")
        place(s, f"R{first + 3}", p.SHUNT, p1=f"COIL{n}_NODE", p2=f"SHUNT{n}+", p3=f"SHUNT{n}-", p4=f"COIL{n}+")
        place(s, f"U{first}", p.AMPLIFIER, p1=f"SHUNT{n}-", p2="GND", p3="GND", p5=f"AMPLIFIED{n}", p6="V3", p7="GND", p8=f"SHUNT{n}+")
        two(s, f"C{first}", p.C100N, "V3", "GND")
        two(s, f"R{first + 4}", p.resistor("1K"), f"AMPLIFIED{n}", f"CURRENT{n}")
        two(s, f"C{first + 1}", p.C10N, f"CURRENT{n}", "GND")
        place(s, f"TP{first}", p.TEST_POINT, p1=f"AMPLIFIED{n}")
        two(s, f"D{first + 2}", p.SCHOTTKY, f"FUSED{n}", f"COIL{n}-")
        place(s, f"Q{first + 2}", p.LOW_SIDE, p1=f"LOW_GATE{n}", p2=f"COIL{n}-", p3="GND")
        two(s, f"R{first + 5}", p.resistor("10R"), f"LOW_DRIVE{n}", f"LOW_GATE{n}")
        two(s, f"R{first + 6}", p.resistor("10K"), f"LOW{n}", "GND")
    s = "both coils"
    place(s, "J4", p.header(4, "Phoenix Contact", "1757268", "coils"), p1="COIL1+", p2="COIL1-", p3="COIL2+", p4="COIL2-")
    place(s, "U8", p.GATE_DRIVER, p2="LOW1", p3="GND", p4="LOW2", p5="LOW_DRIVE2", p6="V12", p7="LOW_DRIVE1")
    two(s, "C80", p.C2U2, "V12", "GND")
    place(s, "U9", p.COMPARATOR, p1="BREAK", p2="AMPLIFIED1", p3="TRIP", p4="GND", p5="TRIP", p6="AMPLIFIED2", p7="BREAK", p8="V3")
    two(s, "C81", p.C100N, "V3", "GND")
    two(s, "R80", p.resistor("620R"), "V3", "TRIP")
    two(s, "R81", p.resistor("10K"), "TRIP", "GND")
    two(s, "C82", p.C100N, "TRIP", "GND")
    two(s, "R82", p.resistor("4K7"), "V3", "BREAK")


def rows():
    """The netlist: part, number and name of the pin, net; parts and pins in order."""
    for ref in SHEET:
        part = next(part for part in default_circuit.parts if part.ref == ref)
        for pin in part.pins:
            connected = [n.name for n in pin.nets if n is not NC]
            yield ref, pin.num, pin.name, connected[0] if connected else ""


def main(folder):
    import draw
    import rules
    supply(), processor(), sensors(), encoder_and_link(), coils()
    skidl.ERC()
    found = [f"SKiDL: {skidl.erc_logger.error.count} errors, {skidl.erc_logger.warning.count} warnings"] \
        if skidl.erc_logger.error.count or skidl.erc_logger.warning.count else []
    kinds = {part.ref: part.fields for part in default_circuit.parts}
    netlist = list(rows())
    found += rules.violations(netlist, kinds) + rules.blind(netlist, kinds)
    if found:
        sys.exit("\n".join(found))
    with open(folder / "netlist.csv", "w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([("part", "pin", "name", "net"), *netlist])
    rules.parts_list(kinds, folder / "parts.csv")
    for sheet in dict.fromkeys(SHEET.values()):
        shown = [ref for ref in SHEET if SHEET[ref] == sheet]
        (folder / f"{sheet.replace(' ', '-')}.svg").write_text(draw.sheet(sheet, shown, netlist, kinds), encoding="utf-8")
    print(f"{len(SHEET)} parts, {len({net for *_, net in netlist if net})} nets: no violation")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
