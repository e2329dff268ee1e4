"""Which line of a corrected program is which of the original, by their text alone."""
import re

NUMBER = r'[-+]?[ \t]*(?:\d|\.[ \t]*\d)(?:[ \t]*[\d.,])*'
TOKEN = re.compile(r'(\([^)]*\)?|;.*)|([ \t]*)(Q203(?=[ \t]*=)|[A-Za-z])([ \t]*=?[ \t]*)(' + NUMBER + r')|(.)', re.S)
CORRECTED = set('XYZIJKR') | {'Q203'}  # letters whose numbers a correction may change, the surface of Klartext's holes
INSERTED = set('XYZIJKR')   # words that it may insert; besides the motion G0 to G3, and F where it means time
ARC = set('IJKRP')
WEIGHT = dict.fromkeys('XYZ', 1.0) | dict.fromkeys('IJKR', 0.01)  # half arcs have other centres, the same end
MOST_CORRECTED = 0.7        # mm, or 0.0276 inch: more than any correction of these programs
BEAM = 60                   # alignments that are followed side by side


def value(number):
    return float(number.replace(' ', '').replace('\t', '').replace(',', '.').rstrip('.') or 'nan')


class Line:
    """A line's words (blanks before, letter, between, number) and the rest, in order."""

    def __init__(self, text):
        self.text = text
        self.tokens = []
        for m in TOKEN.finditer(text):
            if m.group(3):
                self.tokens.append((m.group(2), m.group(3).upper(), m.group(4), m.group(5)))
            else:
                self.tokens.append(m.group(0))
        self.number = self.take_number()
        self.words = [t for t in self.tokens if isinstance(t, tuple)]
        self.letters = {t[1] for t in self.words}
        self.inverse_time = False  # whether F says it; known where the lines before are
        self.relative = False      # G91; likewise
        self.step = [sum(value(t[3]) for t in self.words if t[1] == letter) for letter in 'XYZ']
        self.motion = [t for t in self.words if is_motion(t)]
        self.is_piece = bool(self.words) and all(isinstance(t, tuple) and (t[1] in INSERTED | {'F'} or is_motion(t)) or
                                                 t in ('/', ' ', '\t', '\r', 'L') for t in self.tokens)

    def take_number(self):
        """The N, with the blanks behind it: a split block gives it to its first piece."""
        at = next((i for i, t in enumerate(self.tokens) if isinstance(t, tuple) and t[1] == 'N'), None)
        if at is None or any(t not in ('/', ' ', '\t') for t in self.tokens[:at]):
            return None
        blanks, _, _, number = self.tokens.pop(at)
        while at < len(self.tokens) and self.tokens[at] in (' ', '\t'):
            self.tokens.pop(at)
        if at < len(self.tokens) and isinstance(self.tokens[at], tuple):
            self.tokens[at] = (blanks,) + self.tokens[at][1:]
        return int(value(number))


def is_motion(token):
    return isinstance(token, tuple) and token[1] == 'G' and value(token[3]) in (0, 1, 2, 3)


def is_inserted(token, per_minute_too):
    return isinstance(token, tuple) and (token[1] in INSERTED or is_motion(token) or per_minute_too and token[1] == 'F')


def cost_of(o, c, inverse_time=False):
    """How far the numbers of `c` are from those of `o`, of which it must be a corrected version, byte for byte; None:
    it is not. A chorded arc may have lost its arc words, and its motion word may be another."""
    i = j = 0
    cost = 0.0
    chorded = any(value(t[3]) == 1 for t in c.motion) and not (c.letters & set('IJKR'))
    while i < len(o.tokens) or j < len(c.tokens):
        a = o.tokens[i] if i < len(o.tokens) else None
        b = c.tokens[j] if j < len(c.tokens) else None
        if a == b:
            i, j = i + 1, j + 1
        elif isinstance(a, tuple) and isinstance(b, tuple) and a[:3] == b[:3] and (
                a[1] in CORRECTED or inverse_time and a[1] == 'F' or chorded and is_motion(a) and is_motion(b)):
            cost += WEIGHT.get(a[1], 0.0) * abs(value(a[3]) - value(b[3]))
            i, j = i + 1, j + 1
        elif chorded and isinstance(a, tuple) and a[1] in ARC:
            i += 1
        elif b is not None and is_inserted(b, inverse_time):
            cost += 1e-3
            j += 1
        else:
            return None
    return cost


def split_lines(text):
    return text.decode('latin-1').split('\n')


def without_header(lines):
    """Without the comments that say that the program is a corrected one, which stand together near its start."""
    first = next((i for i, line in enumerate(lines) if 'COUNTERFLEX 1' in line), None)
    if first is None:
        return lines, 0, 0
    last = first
    while last < len(lines) and 'COUNTERFLEX' in lines[last]:
        last += 1
    return lines[:first] + lines[last:], first, last - first


class Mismatch(Exception):
    pass


def advance(states, o, corrected, parsed, last):
    """The states (lines of the corrected program used up: cost, what they were) after one line more of the original,
    which is `corrected[last]` at the latest."""
    after, carried, j = {}, None, min(states)
    piece = 1e-3 if o.letters & INSERTED else 1.0  # a block that moves nothing has pieces only behind one that goes first
    gone = [0.0, 0.0, 0.0]  # by the pieces that are carried, where numbers are differences
    while j <= last:
        here = states.get(j)
        if here and (carried is None or here[0] < carried[0]):
            carried, gone = here, [0.0, 0.0, 0.0]
        elif carried is None:
            j = min((used for used in states if used > j), default=last + 1)
            continue
        if parsed[j] is None:
            parsed[j] = Line(corrected[j])
        step = 0.0 if corrected[j] == o.text else cost_of(o, parsed[j], o.inverse_time)
        reached = [a + b for a, b in zip(gone, parsed[j].step)]
        if step is not None and o.relative:
            step = sum(abs(a - b) for a, b in zip(reached, o.step))
        if step is not None:
            after[j + 1] = (carried[0] + step, (j, carried[1]))
        carried, gone = (carried[0] + piece, carried[1]) if parsed[j].is_piece else None, reached
        j += 1
    return after


def align(original, corrected):
    """For each line of `original` the index of its version in `corrected` (lists of lines); the lines between are
    inserted. Takes the alignment with the nearest numbers. Raises Mismatch at the first line that has no version."""
    parsed = [None] * len(corrected)
    states, inverse_time, relative = {0: (0.0, None)}, False, False
    inserted = len(corrected) - len(original)
    if inserted < 0:
        raise Mismatch('%d lines became %d' % (len(original), len(corrected)))
    for index, text in enumerate(original):
        inverse_time = inverse_time or bool(re.search(r'G\s*93(?!\d)', text, re.I))
        distance = re.findall(r'G\s*9([01])(?![\d.])', re.sub(r'\([^)]*\)', '', text), re.I)
        relative = distance[-1] == '1' if distance else relative
        line = Line(text)
        line.inverse_time, line.relative = inverse_time, relative
        after = advance(states, line, corrected, parsed, index + inserted)
        if not after:
            best = min(states, key=lambda used: states[used][0])
            raise Mismatch('line %d, %r, became about %r' % (
                index + 1, text[:60], corrected[min(best, len(corrected) - 1)][:60]))
        if len(after) > BEAM:
            after = dict(sorted(after.items(), key=lambda item: item[1][0])[:BEAM])
        states = after
    if len(corrected) not in states:
        raise Mismatch('%d lines follow the last one' % (len(corrected) - max(states)))
    versions, trail = [], states[len(corrected)][1]
    while trail:
        versions.append(trail[0])
        trail = trail[1]
    check_numbers(original, corrected, versions[::-1])
    return versions[::-1]


def may_end(block, piece):
    """Whether `piece` can be the last one of `block`, whose first piece is its version as it says more than where to go."""
    ends = {t[1]: value(t[3]) for t in block.words if t[1] in 'XYZ'}
    reached = {t[1]: value(t[3]) for t in piece.words if t[1] in 'XYZ'}
    return all(abs(ends[letter] - reached[letter]) < MOST_CORRECTED for letter in ends.keys() & reached.keys())


def first_pieces(original, corrected, versions, index):
    """Where the pieces of a block can begin: behind the version of the block before it, or, where that is the first piece of
    its own, behind its last one."""
    if index == 0:
        return [0]
    first, block = versions[index - 1] + 1, Line(original[index - 1])
    says_more = any(isinstance(t, tuple) and not is_inserted(t, True) for t in block.tokens)
    if not says_more or not block.letters & set('XYZ'):
        return [first]
    return [j for j in range(first, versions[index] + 1) if may_end(block, Line(corrected[j - 1]))]


def check_numbers(original, corrected, versions):
    """The numbers are those of the original, in its order; that of a split block is on its first piece."""
    wanted = [(n, index) for index, n in enumerate(Line(text).number for text in original) if n is not None]
    found = [(n, j) for j, n in enumerate(Line(text).number for text in corrected) if n is not None]
    if [n for n, _ in wanted] != [n for n, _ in found]:
        raise Mismatch('the numbers of blocks are not those of the original')
    increments = any(re.search(r'G\s*91(?![\d.])', line, re.I) for line in original)
    for (number, index), (_, j) in zip(wanted, found):
        if not (versions[index - 1] if index > 0 else -1) < j <= versions[index]:
            raise Mismatch('N%d is not on a piece of its block' % number)
        if not increments and j not in first_pieces(original, corrected, versions, index):
            raise Mismatch('N%d is not on the first piece of its block' % number)
