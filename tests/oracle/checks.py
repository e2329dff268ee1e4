"""The checks: each takes one program and returns what is wrong with it, or an empty text."""
import os
import re

import compare
import facts
import helix
import limits
import linear
import path
import plain
import product
import text

OFFSETS = {1: (12.0, -7.5, 30.0), 2: (-40.0, 25.0, 3.25), 3: (1.0, 2.0, 3.0), 4: (5.0, -5.0, 5.0), 5: (0.5, 0.5, 0.5),
           6: (-3.0, 0.0, 9.0)}
AT_ORIGIN = {number: (0.0, 0.0, 0.0) for number in OFFSETS}
LENGTHS = {tool: 40.0 + 2.5 * (tool % 40) for tool in range(1, 300)}
SQUARE = 1e-3  # rad
TOLERANCE = 0.005
SAME = 2e-6  # mm: what the seventh decimal of an inch hides


class Shop:
    """What all checks share: the product, the interpreter, and what a folder says of its programs."""

    def __init__(self, runs, interpreter, folder, known):
        self.runs, self.interpreter, self.folder, self.known = runs, interpreter, folder, known
        self.notes, self.refused = [], set()

    def about(self, program):
        return self.known.get(os.path.splitext(os.path.basename(program))[0], {})

    def options(self, program):
        return tuple(self.about(program).get('options', ()))

    def gantry(self, program, **given):
        return product.Gantry(program=self.about(program).get('program', ''), **given)

    def bench(self, offsets, lengths):
        return path.Bench(self.interpreter, self.folder, offsets, lengths)


def is_klartext(program):
    return program.endswith('.h')


def body_of(program, text_bytes):
    lines, _, _ = text.without_header(text.split_lines(text_bytes))
    if is_klartext(program):
        lines = [re.sub(r'^\d+ ?', '', line) for line in lines]
    return lines


def refusal(shop, program, run):
    """A run that gave no program: an error, or a note where the rules may refuse it."""
    if not run.refused_with_place(os.path.basename(program)):
        return 'exit %d: %s' % (run.status, run.said[-300:])
    if shop.about(program).get('may_be_refused'):
        shop.notes.append('%s: refused: %s' % (os.path.basename(program), run.said.splitlines()[-1]))
        shop.refused.add(program)
        return ''
    return run.said[-300:]


def identity(shop, program):
    """A perfect machine without forces gives the input back, header aside."""
    run = shop.runs.compensate(program, shop.gantry(program, offsets=AT_ORIGIN), options=shop.options(program))
    name = os.path.basename(program)
    if shop.about(program).get('wrong'):
        return '' if run.refused_with_place(name) else 'was not refused at a place, exit %d: %s' % (run.status, run.said[-200:])
    if run.status != 0:
        return 'exit %d: %s' % (run.status, run.said[-300:])
    original, corrected = body_of(program, open(program, 'rb').read()), body_of(program, run.text)
    for number, (a, b) in enumerate(zip(original, corrected), 1):
        if a != b:
            return 'line %d: %r became %r' % (number, a[:80], b[:80])
    return '' if len(original) == len(corrected) else '%d lines became %d' % (len(original), len(corrected))


class Corrected:
    """A corrected program beside its original: aligned by text, walked by the interpreter."""

    def __init__(self, shop, program, gantry, lengths, told=True):
        self.original = open(program, 'rb').read()
        self.run = shop.runs.compensate(program, gantry, lengths if told else None, shop.options(program))
        self.bench = shop.bench(gantry.offsets, lengths)
        if self.run.status == 0:
            self.align()

    def align(self):
        lines, first, count = text.without_header(text.split_lines(self.run.text))
        versions = text.align(text.split_lines(self.original), lines)
        self.line_of_version, done = {}, -1
        for number, index in enumerate(versions, 1):
            for j in range(done + 1, index + 1):
                self.line_of_version[(j + 1 if j < first else j + 1 + count)] = number
            done = index
        self.left_alone = {row['line'] for key in ('left_alone', 'machine_positions')
                           for row in self.run.report['blocks'][key]}

    def line_of(self, line):
        return self.line_of_version.get(line, max(self.line_of_version.values()) + 1)

    def walk(self, skip=False):
        lines = plain.plain_lines(self.original)
        self.facts = facts.facts_of(lines)
        unit = 'G20' if facts.says_inches_first(lines) else 'G21'
        steps = path.walk(self.bench, lines, unit, skip)
        try:
            written = path.walk(self.bench, plain.plain_lines(self.run.text), unit, skip)
        except path.Refused as error:
            raise text.Mismatch('LinuxCNC refuses the corrected program: %s' % error)
        pairs, wrong = compare.pairs_of(steps, written, self.line_of)
        if wrong:
            raise text.Mismatch(wrong)
        return compare.give_back(pairs, self.facts)


def judged_text(shop, program, findings):
    if findings:
        return findings.text()
    left = ', contours leave %.4f mm' % findings.contours_leave if findings.contours_leave is not None else ''
    shop.notes.append('%s: %d of %d ends judged%s' % (os.path.basename(program), findings.judged, findings.total, left))
    return ''


def against_interpreter(shop, program, gantry, lengths, check_of, skip=False):
    """`check_of` makes a check from a Corrected whose facts are known."""
    try:
        path.walk(shop.bench(gantry.offsets, lengths), plain.plain_lines(open(program, 'rb').read()))
    except path.Refused as error:
        shop.notes.append('%s: LinuxCNC does not read it: %s' % (os.path.basename(program), error))
        return ''
    try:
        both = Corrected(shop, program, gantry, lengths)
        if both.run.status != 0:
            return refusal(shop, program, both.run)
        pairs = both.walk(skip)
        return judged_text(shop, program, check_of(both).run(pairs))
    except text.Mismatch as error:
        return str(error)


def shift_with(shop, program, offsets, lengths, skip=False):
    gantry = shop.gantry(program, shift=product.FRAME_SHIFT, offsets=offsets)
    return against_interpreter(shop, program, gantry, lengths,
                               lambda both: compare.ShiftCheck(product.FRAME_SHIFT, both.facts, both.left_alone), skip)


def shift(shop, program):
    return shift_with(shop, program, AT_ORIGIN, {})


def shift_skipped(shop, program):
    """Again with the control's switch for blocks with '/' on."""
    return shift_with(shop, program, AT_ORIGIN, {}, skip=True)


def shift_offsets(shop, program):
    """Again with offsets and tool lengths that are not zero."""
    return shift_with(shop, program, OFFSETS, LENGTHS)


def field(shop, program, **errors):
    gantry = shop.gantry(program, **errors, offsets=OFFSETS)

    def check_of(both):
        return linear.FieldCheck(gantry, both.facts, both.left_alone, TOLERANCE + 2e-4)
    return against_interpreter(shop, program, gantry, LENGTHS, check_of)


def field_positive(shop, program):
    return field(shop, program, squareness=(SQUARE, -SQUARE, SQUARE))


def field_negative(shop, program):
    return field(shop, program, squareness=(-SQUARE, SQUARE, -SQUARE))


def field_turned(shop, program):
    """A machine that is turned and leans turns its contours, and changes their heights."""
    return field(shop, program, turned=(SQUARE, -0.5 * SQUARE, 0.3 * SQUARE))


def offsets(shop, program):
    """LinuxCNC takes the words of predict --offsets: all motion moves by exactly their change, and leaves what they promise."""
    gantry = shop.gantry(program, shift=product.FRAME_SHIFT, squareness=(SQUARE, -SQUARE, SQUARE), offsets=OFFSETS)
    report, said = shop.runs.offsets(program, gantry, shop.options(program))
    if not report:
        shop.notes.append('%s: refused: %s' % (os.path.basename(program), (said.splitlines() or [''])[-1]))
        shop.refused.add(program)
        return ''
    found, lines = report['offsets'], plain.plain_lines(open(program, 'rb').read())
    unit = 'G20' if facts.says_inches_first(lines) else 'G21'
    words = [word for work in found['work'] for word in work['words']]
    stated = 'G20' if report['units']['program'] == 'inch' else 'G21'
    bench = shop.bench(OFFSETS, {})
    try:
        before = path.walk(bench, lines, unit)
    except path.Refused as error:
        shop.notes.append('%s: LinuxCNC does not read it: %s' % (os.path.basename(program), error))
        return ''
    begin = next((number for number, line in enumerate(lines, 1) if line.strip() == '%'), 0)
    after = path.walk(bench, lines[:begin] + [stated, *words, unit] + lines[begin:], unit)
    if len(before) != len(after):
        return '%d steps became %d' % (len(before), len(after))
    shifts, worst = [work['shift_mm'] for work in found['work']] + [[0, 0, 0]], 0
    for a, b in zip(before, after):
        moved = [q - p for p, q in zip(a.offset, b.offset)]
        if not any(max(abs(m - s) for m, s in zip(moved, shift)) < SAME for shift in shifts):
            return 'line %d: the offset moves by %s instead of one of %s' % (a.line, moved, shifts)
        same = [abs(p - q) < SAME for p, q in zip(a.end, b.end)]
        rests = [abs(q + m - p) < SAME for p, q, m in zip(a.end, b.end, moved)]  # an axis that has no word yet
        if not all(s or r for s, r in zip(same, rests)):
            return 'line %d: program coordinates change from %s to %s' % (a.line, a.end, b.end)
        if a.kind in ('feed', 'arc') and all(same):
            wanted, reached = [p + o for p, o in zip(a.end, a.offset)], gantry.reached([p + o for p, o in zip(b.end, b.offset)])
            worst = max(worst, sum((r - w) ** 2 for r, w in zip(reached, wanted)) ** 0.5)
    cycles = any(re.search(r'(?i)G(73|76|8[1-9])(?!\d)', line) for line in lines)  # holes are no part of the search
    if found['tools'] or cycles or report['blocks']['left_alone_count']:
        return ''
    shop.notes.append('%s: %.4f mm of %.4f left' % (os.path.basename(program), worst, found['before']['max_mm']))
    if worst > found['rest']['max_mm'] + SAME:
        return '%.7f mm are left instead of %.7f' % (worst, found['rest']['max_mm'])
    return ''


def guarded_lines(raw):
    """As `plain_lines`, but the checks that counterflex wrote are left as they are."""
    lines = plain.plain_lines(raw)
    for number, line in enumerate(raw.decode('latin-1').split('\n')):
        if re.match(r'o<counterflex_guard_|\(CF [0-9A-F]{8}\) \(abort, COUNTERFLEX GUARD', line):
            lines[number] = line.rstrip('\r')
    return lines


def stops(bench, lines, unit):
    """Whether a guard stops the program."""
    try:
        path.walk(bench, lines, unit)
        return False
    except path.Refused as error:
        if 'COUNTERFLEX GUARD' in str(error):
            return True
        raise


def moved(offsets, number, axis, by):
    xyz = list(offsets[number])
    xyz[axis] += by
    return {**offsets, number: tuple(xyz)}


def guard(shop, program):
    """A guarded program moves as it does without a guard, also with the offset at the edge of the window. With the offset
    or the tool length off by twice the window it stops."""
    gantry = shop.gantry(program, squareness=(SQUARE, -SQUARE, SQUARE), offsets=OFFSETS, shown=True)
    bare = shop.runs.compensate(program, gantry, LENGTHS, shop.options(program))
    if bare.status != 0:
        return refusal(shop, program, bare)
    dialect = bare.report['options']['dialect']
    if bare.report['verdict'] == 'NOTHING CORRECTED':
        shop.notes.append('%s: nothing to guard' % os.path.basename(program))
        return ''
    if dialect != 'linuxcnc':
        shop.notes.append('%s: not judged: %s' % (os.path.basename(program), dialect))
        return ''
    unguarded = plain.plain_lines(bare.text)
    unit = 'G20' if facts.says_inches_first(unguarded) else 'G21'
    calls_of = lambda steps: [(s.kind, s.start, s.end, s.arc, s.offset, s.feed) for s in steps]
    try:
        wanted = calls_of(path.walk(shop.bench(OFFSETS, LENGTHS), unguarded, unit))
    except path.Refused as error:
        shop.notes.append('%s: LinuxCNC does not read it: %s' % (os.path.basename(program), error))
        return ''
    run = shop.runs.compensate(program, gantry, LENGTHS, (*shop.options(program), '--guard'))
    if run.refused_with_place(os.path.basename(program)):  # it may set the offset itself
        shop.notes.append('%s: refused: %s' % (os.path.basename(program), run.said.splitlines()[-1]))
        shop.refused.add(program)
        return ''
    if run.status != 0:
        return 'exit %d: %s' % (run.status, run.said[-300:])
    guarded = guarded_lines(run.text)
    try:
        if calls_of(path.walk(shop.bench(OFFSETS, LENGTHS), guarded, unit)) != wanted:
            return 'the guard changes the motion'
        written = run.report['guard']
        number, window = int(written['work'][1:3]) - 53, written['window_mm']
        for axis in range(3):
            for sign in (-1, 1):
                if stops(shop.bench(moved(OFFSETS, number, axis, 0.99 * sign * window), LENGTHS), guarded, unit):
                    return 'it stops with the offset inside of the window'
                if not stops(shop.bench(moved(OFFSETS, number, axis, 2 * sign * window), LENGTHS), guarded, unit):
                    return 'it does not stop with the offset off by twice the window along axis %d' % axis
        if written['tool_length_mm'] is not None:
            other = {tool: length + 2 * window for tool, length in LENGTHS.items()}
            if not stops(shop.bench(OFFSETS, other), guarded, unit):
                return 'it does not stop with the tool length off by twice the window'
    except path.Refused as error:
        return 'LinuxCNC refuses it: %s' % error
    shop.notes.append('%s: guarded within %g mm, %d steps' % (os.path.basename(program), window, len(wanted)))
    return ''


def calls(shop, program):
    """The interpreter runs the original's calls itself; with them expanded, each is corrected where it runs."""
    shifted = product.Gantry(shift=product.FRAME_SHIFT, offsets=AT_ORIGIN)
    skewed = product.Gantry(squareness=(SQUARE, -SQUARE, SQUARE), offsets=AT_ORIGIN)
    original = text.split_lines(open(program, 'rb').read())
    bench = shop.bench(AT_ORIGIN, {})
    steps = path.walk(bench, original)
    for gantry in (shifted, skewed):
        run = shop.runs.compensate(program, gantry, options=('--expand-subprograms',))
        if run.status != 0:
            return 'exit %d: %s' % (run.status, run.said[-300:])
        if any(s.arc for s in steps) and gantry is skewed:
            continue  # there corrected arcs are other arcs
        wrong = compare.moved_apart(steps, path.walk(bench, text.split_lines(run.text)), gantry.commanded, 0.002)
        if wrong:
            return wrong
    shop.notes.append('%s: %d ends judged' % (os.path.basename(program), len(steps)))
    return ''


def masking(shop, program):
    """With numbers masked and what was inserted removed the corrected program is the original, byte for byte. Helices of
    Klartext may have become lines."""
    for gantry in (shop.gantry(program, shift=product.FRAME_SHIFT, offsets=AT_ORIGIN),
                   shop.gantry(program, squareness=(SQUARE, -SQUARE, SQUARE), offsets=AT_ORIGIN)):
        run = shop.runs.compensate(program, gantry, options=shop.options(program))
        if run.status != 0:
            wrong = refusal(shop, program, run)
            if wrong:
                return wrong
            continue
        try:
            original, corrected = body_of(program, open(program, 'rb').read()), body_of(program, run.text)
            if is_klartext(program):
                corrected = helix.with_helices(original, corrected, gantry.reached, TOLERANCE + 2e-4)
            text.align(original, corrected)
        except text.Mismatch as error:
            return str(error)
    return ''


def control_limits(shop, program):
    """No output line is too long and no arc refused, by LinuxCNC's rules and by GRBL's where the source keeps them."""
    gantry = shop.gantry(program, squareness=(SQUARE, -SQUARE, SQUARE), offsets=AT_ORIGIN)
    run = shop.runs.compensate(program, gantry, options=shop.options(program))
    if run.status != 0:
        return refusal(shop, program, run)
    grbl = shop.about(program).get('grbl', False)
    for number, line in enumerate(text.split_lines(run.text), 1):
        wrong = limits.too_long(line, grbl)
        if wrong:
            return 'line %d has %s' % (number, wrong)
    try:
        before, after = (arcs(shop, raw) for raw in (open(program, 'rb').read(), run.text))
    except path.Refused as error:
        shop.notes.append('%s: LinuxCNC does not read it: %s' % (os.path.basename(program), error))
        return ''
    if after and not before:
        return '%d arcs would be refused; line %d of the output: %s' % (len(after), after[0][0].line, after[0][1])
    return ''


def arcs(shop, raw):
    lines = plain.plain_lines(raw)
    unit = 'G20' if facts.says_inches_first(lines) else 'G21'
    return list(limits.arcs_refused(path.walk(shop.bench(AT_ORIGIN, {}), lines, unit), facts.facts_of(lines)))


def shares(shop, program):
    """As many moves are corrected or held as was counted by hand."""
    wanted = shop.about(program).get('share')
    if not wanted:
        return ''
    report, said = shop.runs.plan(program, shop.gantry(program, offsets=AT_ORIGIN), shop.options(program))
    if not report:
        return said[-300:]
    plan = plan_of(report)
    if plan is None:
        return 'check prints no plan'
    found = [plan['corrected'] + plan['held'] + plan['grouped'], plan['moves']]
    return '' if found == wanted else '%d of %d moves corrected or held instead of %d of %d' % (*found, *wanted)


def plan_of(report):
    """The object of key `plan`, wherever it stands."""
    if isinstance(report, dict):
        if 'plan' in report:
            return report['plan']
        report = list(report.values())
    for part in report if isinstance(report, list) else []:
        found = plan_of(part)
        if found:
            return found
    return None


ALL = {'identity': identity, 'shift': shift, 'shift_skipped': shift_skipped, 'shift_offsets': shift_offsets,
       'field_positive': field_positive, 'field_negative': field_negative, 'field_turned': field_turned,
       'masking': masking, 'offsets': offsets, 'limits': control_limits, 'shares': shares, 'calls': calls, 'guard': guard}
G_CODE_ONLY = {'shift', 'shift_skipped', 'shift_offsets', 'field_positive', 'field_negative', 'field_turned', 'limits', 'calls', 'guard', 'offsets'}
