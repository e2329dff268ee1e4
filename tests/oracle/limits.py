"""What LinuxCNC and GRBL accept of a block: its length and an arc's radii. Own implementations of their rules."""
import math
import re

LINUXCNC_LINE = 255  # characters, comments included
GRBL_LINE = 80       # characters without comments and blanks


def too_long(line, grbl):
    """None, or what is said of the length of a raw line."""
    code = re.sub(r'\([^)]*\)?|\s', '', line).split(';')[0]
    if len(line.rstrip('\r')) > LINUXCNC_LINE:
        return '%d characters' % len(line)
    if grbl and len(code) > GRBL_LINE:
        return '%d characters without blanks and comments' % len(code)
    return None


def linuxcnc_refuses(r0, r1):
    """Radii (mm) at an arc's start and end."""
    error = abs(r0 - r1)
    limit = 0.0011 * 25.4 * 1.01  # 0.0283 mm
    return error > 100 * limit or (error > limit and error > 0.001 * max(r0, r1))


def grbl_refuses(r0, r1):
    error = abs(r0 - r1)
    return error > 0.5 or (error > 0.005 and error > 0.001 * r0)


def radius_too_small(step, radius):
    """Whether an arc in R format (mm) cannot reach its end: GRBL takes no less than half the chord, read in single
    precision; LinuxCNC is more lenient."""
    a = step.arc
    chord = math.hypot(step.end[a.first] - step.start[a.first], step.end[a.second] - step.start[a.second])
    return chord > 2 * abs(radius) * (1 + 1e-7)


def arcs_refused(steps, facts):
    """Steps that a control would not accept, each with why. What the radius of R format makes of itself fits."""
    for step in steps:
        if not step.arc:
            continue
        fact = facts.get(step.line, {})
        radius = fact.get('radius')
        if radius is not None:
            if radius_too_small(step, radius * (25.4 if fact['inches'] else 1)):
                yield step, 'R%g is less than half its chord' % radius
            continue
        r0, r1 = step.radii()
        if linuxcnc_refuses(r0, r1):
            yield step, 'LinuxCNC refuses radii %.5f and %.5f' % (r0, r1)
        elif grbl_refuses(r0, r1):
            yield step, 'GRBL refuses radii %.5f and %.5f' % (r0, r1)
