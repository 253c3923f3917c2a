"""Mistakes for whole_engine_mistakes.py that are made in a part only: in one component, on one side, for one body of a pair,
for static bodies, or in correcting positions alone."""

MOVE = '                b.x += b.vx * self.dt\n                b.y += b.vy * self.dt\n'
GRAVITY = 'b.vy += (self.g[1] + b.fy * b.im) * h'
PUSH_OUT = 'push = SHARE * max(0.0, depth - SLOP) / inverse_mass(a, b, rax, ray, rbx, rby, nx, ny)'
OVERLAP = 'overlap = self.extent(a, nx, ny) + self.extent(b, nx, ny) - abs(dx * nx + dy * ny)'
EXTENT = 'return box.hw * abs(nx * xx + ny * xy) + box.hh * abs(nx * yx + ny * yy)'
WALL = 'return [(dx / d, dy / d, a.r - d, wx, wy)]'
FIX = 'push = SHARE * error / inverse_mass(a, b, rax, ray, rbx, rby, nx, ny)'
RATE = 'j = -rate / inverse_mass(a, b, rax, ray, rbx, rby, nx, ny)'
ONE_IF_STATIC = '(a.im or 1) + (b.im or 1) + cross(rax, ray, nx, ny) ** 2 * a.ii + cross(rbx, rby, nx, ny) ** 2 * b.ii'

# name, first chapter that shows it, old text, new text, the name that describes it
MISTAKES = [
    ('y moves by the old velocity', 1,
     GRAVITY, 'b.vy, b.old = b.vy + (self.g[1] + b.fy * b.im) * h, b.vy', "explicit_euler",
     'b.y += b.vy * self.dt', 'b.y += b.old * self.dt'),
    ('x moves by v/60', 1, 'b.x += b.vx * self.dt', 'b.x += b.vx / 60', "per_frame"),
    ('vy without dt', 1, GRAVITY, 'b.vy += self.g[1] + b.fy * b.im', "dt_missing"),
    ('x of gravity twice', 1, '(self.g[0] + b.fx * b.im)', '(2 * self.g[0] + b.fx * b.im)', "gravity_twice"),
    ('normal of a wall always to the left', 1, WALL, 'return [(abs(dx / d), dy / d, a.r - d, wx, wy)]', "sign_lost"),
    ('normal of a wall always up', 1, WALL, 'return [(dx / d, -abs(dy / d), a.r - d, wx, wy)]', "sign_lost"),
    ('x of the forces piles up', 2, 'b.fx = b.fy = b.torque = 0.0\n        WORLD', 'b.fy = b.torque = 0.0\n            b.fx = getattr(b, "fx", 0.0)\n        WORLD',
     "force_not_cleared"),
    ('forces on the first body pile up', 2, '        for b in self.bodies:\n            b.fx', '        for b in self.bodies[self.n > 0:]:\n            b.fx',
     "force_not_cleared"),
    ('y of a force not divided by the mass', 2, 'self.g[1] + b.fy * b.im', 'self.g[1] + b.fy', "mass_not_divided"),
    ('x of drag with the speed', 2, 'b.fx -= f["coefficient"] * b.vx', 'b.fx -= f["coefficient"] * b.vx * hypot(b.vx, b.vy)', "drag_quadratic"),
    ('y of drag pushes', 2, 'b.fy -= f["coefficient"] * b.vy', 'b.fy += f["coefficient"] * b.vy', "axis_reversed"),
    ('a spring pulls one end along y', 2, 'self.push(b, -force * dx, -force * dy, rbx, rby)', 'self.push(b, -force * dx, 0, rbx, rby)',
     "spring_at_one_end"),
    ('x of a spring with its sign lost', 2, 'dx, dy = dx / length, dy / length', 'dx, dy = abs(dx) / length, dy / length', "sign_lost"),
    ('y of the normal of circles always positive', 3, 'nx, ny = dx / d, dy / d\n                return', 'nx, ny = dx / d, abs(dy) / d\n                return',
     "sign_lost"),
    ('static bodies of 1 kg in a contact', 3, 'c["k"] = inverse_mass(a, b, rax, ray, rbx, rby, nx, ny)', f'c["k"] = {ONE_IF_STATIC}', "static_has_mass"),
    ('static bodies of 1 kg in a correction', 3, PUSH_OUT, f'push = SHARE * max(0.0, depth - SLOP) / ({ONE_IF_STATIC})', "static_has_mass"),
    ('static bodies of 1 kg in all', 3, 'return (a.im + b.im + cross(rax, ray, nx, ny) ** 2 * a.ii + cross(rbx, rby, nx, ny) ** 2 * b.ii)',
     f'return {ONE_IF_STATIC}', "static_has_mass"),
    ('only a is divided by in a correction', 3, PUSH_OUT, 'push = SHARE * max(0.0, depth - SLOP) / (a.im or b.im)', "masses_wrong"),
    ('an overlap turns bodies by the other arm', 4, 'a.shift(-push * nx, -push * ny, rax, ray)', 'a.shift(-push * nx, -push * ny, rbx, rby)', ""),
    ('extents of upright boxes', 4, '        xx, xy = box.point(1, 0)\n        yx, yy = box.point(0, 1)', '        xx, xy, yx, yy = 1, 0, 0, 1',
     "extent_not_turned"),
    ('extents turned backwards', 4, EXTENT, 'return box.hw * abs(nx * xx + ny * yx) + box.hh * abs(nx * xy + ny * yy)', "turned_backwards"),
    ('extents of the height alone', 4, EXTENT, 'return box.hh * abs(nx * yx + ny * yy)', "extent_wrong"),
    ('extents with sides exchanged', 4, EXTENT, 'return box.hh * abs(nx * xx + ny * xy) + box.hw * abs(nx * yx + ny * yy)', "extent_wrong"),
    ('extents of circles', 4, EXTENT, 'return hypot(box.hw, box.hh)', "extent_wrong"),
    ('axes of two boxes not turned', 4, 'nx, ny = box.point(lx, ly)\n', 'nx, ny = lx, ly\n', "axes_not_turned"),
    ('axes of b turned by a', 4, 'nx, ny = box.point(lx, ly)\n', 'nx, ny = a.point(lx, ly)\n', "axes_left_out"),
    ('a spring never turns b', 4, 'self.push(b, -force * dx, -force * dy, rbx, rby)', 'self.push(b, -force * dx, -force * dy, 0, 0)',
     "one_body_never_spins"),
    ('speed of a spring with the arm of a', 4, 'bvx, bvy = b.velocity(rbx, rby)\n                rate', 'bvx, bvy = b.velocity(rax, ray)\n                rate',
     "arm_of_the_other"),
    ('sticks are corrected when too short', 5, 'error = d if length is None else d - length', 'error = d if length is None else min(0, d - length)',
     "correction_one_sided"),
    ('errors of sticks without a sign', 5, 'error = d if length is None else d - length', 'error = d if length is None else abs(d - length)', ""),
    ('a correction turns a by the arm of b', 5, 'a.shift(push * nx, push * ny, rax, ray)', 'a.shift(push * nx, push * ny, rbx, rby)', "arm_of_the_other"),
    ('a correction turns both by exchanged arms', 5, 'b.shift(-push * nx, -push * ny, rbx, rby)', 'b.shift(-push * nx, -push * ny, rax, ray)',
     "arm_of_the_other"),
    ('a correction never turns a', 5, 'a.shift(push * nx, push * ny, rax, ray)', 'a.shift(push * nx, push * ny, 0, 0)', "one_body_never_spins"),
    ('the world of 1 kg in a joint', 5, RATE, f'j = -rate / ({ONE_IF_STATIC})', "static_has_mass"),
    ('the world of 1 kg in a correction', 5, FIX, f'push = SHARE * error / ({ONE_IF_STATIC})', "static_has_mass"),
    ('hinges are corrected along x only', 5, '        d = hypot(dx, dy)\n        error = d', '        if length is None:\n            dy = 0.0\n        d = hypot(dx, dy)\n        error = d',
     "hinge_one_axis"),
    ('hinges are not corrected', 5, '                self.fix_joint(joint)', '                if joint[2] is not None:\n                    self.fix_joint(joint)',
     "correction_of_some_joints"),
]
