"""Mistakes for whole_engine_mistakes.py in an engine of another design: hinges corrected along x and then along y, bodies in
contact at a distance of exactly 0, the points of two boxes that share a correction."""

FIX = '                self.fix_joint(joint)'
FIX_BY_ROWS = ('                self.fix_joint(joint, (1, 0))\n'
               '                if joint[2] is None:\n                    self.fix_joint(joint, (0, 1))')
HEAD, HEAD_BY_ROWS = 'def fix_joint(self, joint):', 'def fix_joint(self, joint, axis):'
GAP = '        dx, dy = b.x + rbx - a.x - rax, b.y + rby - a.y - ray\n        d = hypot(dx, dy)\n        error = d if'
ALONG = '        if length is None:\n            dx, dy = axis[0] * dx, axis[1] * dy\n        d = hypot(dx, dy)\n        error = d if'
CALLS = (FIX, FIX_BY_ROWS, HEAD, HEAD_BY_ROWS)
BY_ROWS = (GAP, '        dx, dy = b.x + rbx - a.x - rax, b.y + rby - a.y - ray\n' + ALONG, *CALLS)
CIRCLES = 'if 0 < d < a.r + b.r:'
TOUCHING = ('if 0 < d < a.r:', 'if 0 < d <= a.r:', 'if overlap <= 0:', 'if overlap < 0:', 'if depth > 0:', 'if depth >= 0:')
TIME = 'if t < start - 1e-12 or t >= start + f.get("duration", 1e300) - 1e-12:\n                continue'

# name, first chapter that shows it, old text, new text, the name that describes it
MISTAKES = [
    ('gravity always down', 1, 'self.g = scene["gravity"]', 'self.g = scene["gravity"][0], -abs(scene["gravity"][1])', "sign_lost"),
    ('e of walls', 1, 'e = rule(self.rules["restitution"], a.e, b.e)', 'e = b.e if a.dyn else a.e', "restitution_of_wall"),
    ('endless pushes never act', 2, TIME, TIME.replace("1e300", "0"), "endless_force_ends"),
    ('a push to come ends the loop', 2, TIME,
     'if t < start - 1e-12:\n                break\n            if t >= start + f.get("duration", 1e300) - 1e-12:\n                continue',
     "forces_after_another_lost"),
    ('a spring pulls both ends one way', 2, 'self.push(b, -force * dx, -force * dy, rbx, rby)', 'self.push(b, force * dx, force * dy, rbx, rby)',
     "same_direction_for_both"),
    ('distance by sum', 3, 'd = hypot(dx, dy)\n            ' + CIRCLES, 'd = abs(dx) + abs(dy)\n            if 0 < d <= a.r + b.r:', "distance_by_sum",
     *TOUCHING),
    ('opening contacts left out', 3, '        found = self.contacts()\n',
     '        found = [c for c in self.contacts() if sum(v * n for v, n in zip(self.relative(c), c["n"])) < 0]\n', "opening_contacts_left_out"),
    ('distance along axes with a sign', 4, '- abs(dx * nx + dy * ny)', '- (dx * nx + dy * ny)', "distance_sign_lost"),
    ('point on a turned box not turned', 4, 'return [(dx / d, dy / d, a.r - d, wx, wy)]', 'return [(dx / d, dy / d, a.r - d, b.x + px, b.y + py)]',
     "not_turned", 'if 0 < d < a.r:', 'if 1e-9 < d <= a.r:', *TOUCHING[2:]),
    ('by rows, gap without the arm of b', 5, GAP, '        dx, dy = b.x - a.x - rax, b.y - a.y - ray\n' + ALONG, "wrong_arm", *CALLS),
    ('by rows, correction turns backwards', 5, *BY_ROWS[:2], "correction_turns_backwards", *CALLS,
     'a.shift(push * nx, push * ny, rax, ray)', 'a.shift(push * nx, push * ny, -rax, -ray)',
     'b.shift(-push * nx, -push * ny, rbx, rby)', 'b.shift(-push * nx, -push * ny, -rbx, -rby)'),
]
