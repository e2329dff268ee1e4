"""A program as LinuxCNC's interpreter can read it: what other controls know and what moves nothing is blanked, line by line."""
import re

LINUXCNC_M = {*range(0, 10), 19, 30, *range(48, 54), *range(60, 69), 70, 71, 72, 73, 98, 99}
FLOW = re.compile(r'\s*o\s*(<|\d+\s*(sub|endsub|call|return|while|endwhile|do|if|else|elseif|endif|repeat|endrepeat|'
                  r'break|continue)\b)', re.I)
MOTION = re.compile(r'G\s*0*([0-3]|33(\.1)?|38\.\d|73|76|8[1-9])(?![\d.])', re.I)
AXIS = re.compile(r'[XYZ]\s*[-+.\d\[#]', re.I)
NO_MOTION_OF_ITS_OWN = re.compile(r'G\s*0*(4|10|28|30|52|92)(?![\d])', re.I)
START = re.compile(r'\s*/?\s*(N\s*\d+)?\s*', re.I)


def without_comments(line):
    return re.sub(r'\([^)]*\)?', ' ', line).split(';')[0]


def foreign_removed(code):
    code = re.sub(r'M\s*(\d+)', lambda m: m.group(0) if int(m.group(1)) in LINUXCNC_M else ' ', code, flags=re.I)
    code = re.sub(r'(?<![A-Z<])D\s*\d+(\.\d*)?', 'D0', code, flags=re.I)
    return re.sub(r'^\s*[O:]\s*\d+\s*$', '', code, flags=re.I)


def plain_lines(text):
    """The lines of `text` (bytes), as many as it has, and one more with M2 where nothing ends the program. Cutter radii
    are zero, so that contours come out as they are programmed; after G80 a bare axis block is a rapid, as it is on
    the controls that such programs are for."""
    lines, cancelled, ended = [], False, False
    for raw in text.decode('latin-1').split('\n'):
        code = without_comments(raw.rstrip('\r'))
        if not FLOW.match(code):
            code = foreign_removed(code)
            motion = MOTION.search(code)
            if re.search(r'G\s*80(?!\d)', code, re.I):
                cancelled = not motion
            elif motion:
                cancelled = False
            elif cancelled and AXIS.search(code) and not NO_MOTION_OF_ITS_OWN.search(code):
                at = START.match(code).end()
                code, cancelled = code[:at] + 'G0 ' + code[at:], False
            ended = ended or bool(re.search(r'M\s*0*(2|30)(?!\d)', code, re.I))
        lines.append(code.rstrip())
    return lines + ([] if ended else ['M2'])
