"""What the text of a program says about its lines, read without an interpreter."""
import re

MACHINE_POSITION = re.compile(r'(?<![A-Z])G\s*0*(28|30|53)(?!\d)', re.I)


def has_other_words(code):
    """Whether a block that is split must be the first piece: it says more than where to go."""
    words = re.sub(r'G\s*0*[0-3](?![\d.])|[XYZIJKRFN]\s*[-+]?[\d. ]+|[\s/]', '', code, flags=re.I)
    return bool(words)


def facts_of(lines):
    """A dict by line number (from 1) of plain lines."""
    facts, inches, side = {}, None, False
    for number, code in enumerate(lines, 1):
        if re.search(r'G\s*20(?!\d)', code, re.I): inches = True
        if re.search(r'G\s*21(?!\d)', code, re.I): inches = False
        if re.search(r'G\s*4[12](\.1)?(?![\d])', code, re.I): side = True
        radius = re.search(r'R\s*([-+]?[\d.]+)', code, re.I)
        facts[number] = {
            'axes': {a for a, letter in enumerate('XYZ') if re.search(letter + r'\s*[-+.\d\[#]', code, re.I)},
            'inches': bool(inches),
            'machine': bool(MACHINE_POSITION.search(code)),
            'doubtful': code.lstrip().startswith('/') or bool(re.search(r'[\[#]', code)),
            'side': side,
            'goes_first': has_other_words(code),
            'radius': float(radius.group(1)) if radius else None,
        }
        if re.search(r'G\s*40(?!\d)', code, re.I): side = False
    return facts


def unit_mm(fact):
    """The last digit that a control resolves, in mm."""
    return 0.0001 * 25.4 if fact['inches'] else 0.001


def says_inches_first(lines):
    for code in lines:
        found = re.search(r'G\s*2([01])(?!\d)', code, re.I)
        if found:
            return found.group(1) == '0'
    return False
