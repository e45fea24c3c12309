"""The kinds of parts of the board: pins, maker's number, and what each may be used for."""

from skidl import SKIDL, TEMPLATE, Part, Pin

TYPES = {"P": Pin.types.PASSIVE, "I": Pin.types.INPUT, "O": Pin.types.OUTPUT, "B": Pin.types.BIDIR, "W": Pin.types.PWRIN,
         "S": Pin.types.PWROUT, "C": Pin.types.OPENCOLL, "N": Pin.types.NOCONNECT}

# Highest voltage of each supply, V: with the clamp at work, and at the upper end of the regulators.
HIGHEST = {"V24_IN": 35.0, "V24_FUSED": 35.0, "V24": 35.0, "FUSED1": 35.0, "FUSED2": 35.0, "V12": 12.6, "V5": 5.25, "ENCODER_5V": 5.25,
           "V3": 3.47, "VDDA": 3.47, "LINK_SUPPLY": 5.5, "GND": 0.0, "LINK_GND": 0.0}


def kind(prefix, pins, maker, number, what, **limits):
    """A template. `pins`: number name type, comma between; `limits`: `volts`, what it stands; `of`, share of that it may see."""
    made = [Pin(num=n, name=name, func=TYPES[t]) for n, name, t in (pin.split() for pin in pins.split(","))]
    part = Part(name=number, tool=SKIDL, dest=TEMPLATE, ref_prefix=prefix, pins=made)
    part.fields.update(maker=maker, number=number, what=what, **limits)
    return part


def resistor(value, number=None, what="1 %, 0.1 W", **limits):
    return kind("R", "1 1 P,2 2 P", "Yageo", number or f"RC0603FR-07{value}L", f"{value}, {what}", volts=75, **limits)


def capacitor(value, volts, maker, number, **limits):
    return kind("C", "1 1 P,2 2 P", maker, number, f"{value}, {volts} V", volts=volts, **limits)


def header(count, maker, number, what):
    return kind("J", ",".join(f"{n} {n} P" for n in range(1, count + 1)), maker, number, what)


C100N = capacitor("100 nF", 50, "Murata", "GRM188R71H104KA93D")
C10N = capacitor("10 nF", 50, "Murata", "GRM188R71H103KA01D")
C18P = capacitor("18 pF", 50, "Murata", "GRM1885C1H180JA01D")
C2U2 = capacitor("2.2 µF", 25, "Murata", "GRM188R61E225KA12D")
C10U = capacitor("10 µF", 25, "Murata", "GRM31CR71E106KA12L")
C1U = capacitor("1 µF", 100, "Murata", "GRM31CR72A105KA01L")
C1000U = capacitor("1000 µF", 63, "Panasonic", "EEU-FR1J102")
C470U = capacitor("470 µF", 16, "Panasonic", "EEU-FR1C471")

FUSE_INPUT = kind("F", "1 1 P,2 2 P", "Littelfuse", "0452003.MRL", "3 A, slow, 20 A²s", volts=125)
FUSE_COIL = kind("F", "1 1 P,2 2 P", "Littelfuse", "0451002.MRL", "2 A, very fast", volts=125)
FUSE_ENCODER = kind("F", "1 1 P,2 2 P", "Bourns", "MF-NSMF050-2", "0.5 A, resettable", volts=13.2)
POLARITY = kind("Q", "1 G P,2 D P,3 S P", "Vishay", "SQD50P06-15L_GE3", "P channel, against reverse polarity", volts=60)
HIGH_SIDE = kind("Q", "1 G P,2 D P,3 S P", "Infineon", "IRFR9024NTRPBF", "P channel, high side", volts=55)
LOW_SIDE = kind("Q", "1 G P,2 D P,3 S P", "Infineon", "IRLR2905TRPBF", "N channel, low side", volts=55)
PULLER = kind("Q", "1 G I,2 S P,3 D P", "onsemi", "BSS138", "N channel", volts=50)
SCHOTTKY = kind("D", "1 K P,2 A P", "Vishay", "SS56-E3/57T", "60 V, 5 A", volts=60)
ZENER = kind("D", "1 K P,2 A P", "Diodes", "BZT52C12-7-F", "12 V")
CLAMP = kind("D", "1 K P,2 A P", "Littelfuse", "SMBJ26A", "clamps at 28.9 to 31.9 V")
LIGHT = kind("D", "1 K P,2 A P", "Lite-On", "LTST-C190GKT", "green")
FERRITE = kind("L", "1 1 P,2 2 P", "Murata", "BLM18AG601SN1D", "600 Ω at 100 MHz")
CRYSTAL = kind("Y", "1 1 P,2 2 P", "Abracon", "ABLS-8.000MHZ-B4-T", "8 MHz, 18 pF")
SHUNT = kind("R", "1 I+ P,2 S+ P,3 S- P,4 I- P", "Vishay", "WSK2512R0500FEA", "50 mΩ, 1 %, 1 W, four terminals")
TEST_POINT = kind("TP", "1 1 P", "Keystone", "5015", "test point")
JUMPER = kind("JP", "1 1 P,2 2 P", "Samtec", "TSW-102-07-G-S", "2 pins")

LDO_12 = kind("U", "1 OUT S,2 FB I,3 NC N,4 GND W,5 EN I,6 NC N,7 NC N,8 IN W", "Texas Instruments", "TPS7A4001DGNR", "12 V", volts=100)
BUCK_5 = kind("U", "1 IN W,2 GND W,3 OUT S", "Recom", "R-78HB5.0-0.5", "5 V, 0.5 A", volts=72)
LDO_3 = kind("U", "1 GND W,2 OUT S,3 IN W", "ST", "LD1117S33TR", "3.3 V", volts=15)
AMPLIFIER = kind("U", "1 IN- I,2 GND W,3 REF2 I,4 NC N,5 OUT O,6 VS W,7 REF1 I,8 IN+ I", "Texas Instruments", "INA240A2DR",
                 "50 V/V", volts=80)
COMPARATOR = kind("U", "1 OUTA C,2 INA- I,3 INA+ I,4 VSS W,5 INB+ I,6 INB- I,7 OUTB C,8 VDD W", "Microchip", "MCP6567-E/SN",
                  "two, open drain, rail to rail", volts=5.5)
GATE_DRIVER = kind("U", "1 NC N,2 INA I,3 GND W,4 INB I,5 OUTB O,6 VDD W,7 OUTA O,8 NC N", "Microchip", "TC4427AEOA", "two", volts=18)
RECEIVER = kind("U", "1 1B I,2 1A I,3 1Y O,4 G I,5 2Y O,6 2A I,7 2B I,8 GND W,9 3B N,10 3A N,11 3Y N,12 /G I,13 4Y N,14 4A N,15 4B N,16 VCC W",
                "Texas Instruments", "AM26LV32IDR", "RS-422 receiver", volts=5.5)
ISOLATOR = kind("U", "1 VCC1 W,2 OUTA O,3 INB I,4 GND1 W,5 GND2 W,6 OUTB O,7 INA I,8 VCC2 W", "Texas Instruments", "ISO7721DR",
                "two ways, 3 kV", volts=5.5)
ESD_4 = kind("D", "1 D1+ P,2 D1- P,3 GND P,4 D2+ P,5 D2- P", "Texas Instruments", "TPD4E05U06DQAR", "four lines, 5.5 V")
ESD_422 = kind("D", "1 IO1 P,2 IO2 P,3 GND P", "Semtech", "SM712.TCT", "-7 to 12 V, two lines")
ESD_2 = kind("D", "1 GND P,2 IO1 P,3 IO2 P,4 VCC P", "Nexperia", "PRTR5V0U2X,215", "two lines, 5.5 V")
SENSOR = kind("U", "1 SDO O,2 RESV N,3 RESV N,4 INT1 N,5 VDDIO W,6 GND W,7 RESV N,8 VDD W,9 INT2 N,10 RESV N,11 RESV N,12 CS I,13 SCLK I,14 SDI I",
              "TDK InvenSense", "ICM-42688-P", "on a board of its own", volts=3.6)


def processor(used):
    """STM32F405RGT6 in its LQFP64, with names and types of the used pins by number; the others are left open."""
    power = {1: "VBAT", 12: "VSSA", 13: "VDDA", 18: "VSS", 19: "VDD", 32: "VDD", 48: "VDD", 63: "VSS", 64: "VDD"}
    other = {7: "NRST I", 31: "VCAP1 P", 47: "VCAP2 P", 60: "BOOT0 I"}
    pins = []
    for number in range(1, 65):
        if number in power:
            pins.append(f"{number} {power[number]} W")
        elif number in other:
            pins.append(f"{number} {other[number]}")
        elif number in used:
            pins.append(f"{number} {used[number]}")
        else:
            pins.append(f"{number} open{number} N")
    return kind("U", ",".join(pins), "ST", "STM32F405RGT6", "processor", volts=3.6)
