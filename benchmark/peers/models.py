# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The models of benchmark/answer_cases.hpp, written a second time from docs/towfish.md. x is a state, or states side by side as columns."""
import numpy as np


def wrap(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


class Linear:
    """x' = F x, z = H x."""

    def __init__(self, case):
        self.F, self.H = np.array(case['F']), np.array(case['H'])

    def f(self, x):
        return self.F @ x

    def h(self, x):
        return self.H @ x

    def f_jacobian(self, _):
        return self.F

    def h_jacobian(self, _):
        return self.H


class Towfish:
    """x = north, east, current north, current east, heading, speed; z = antenna north, east, heading, speed."""

    def __init__(self, turn_rate, dt, time_constant, lever_arm):
        self.turn, self.dt, (self.forward, self.starboard) = turn_rate * dt, dt, lever_arm
        self.decay = np.exp(-dt / time_constant)
        self.reach = time_constant * (1 - self.decay)

    def f(self, x):
        north, east, v_north, v_east, heading, speed = x
        middle = heading + self.turn / 2
        return np.stack([north + self.reach * v_north + self.dt * speed * np.cos(middle), east + self.reach * v_east + self.dt * speed * np.sin(middle),
                         self.decay * v_north, self.decay * v_east, wrap(heading + self.turn), speed])

    def h(self, x):
        c, s = np.cos(x[4]), np.sin(x[4])
        return np.stack([x[0] + self.forward * c - self.starboard * s, x[1] + self.forward * s + self.starboard * c, x[4], x[5]])

    def f_jacobian(self, x):
        c, s = np.cos(x[4] + self.turn / 2), np.sin(x[4] + self.turn / 2)
        F = np.diag([1, 1, self.decay, self.decay, 1, 1])
        F[0, 2] = F[1, 3] = self.reach
        F[:2, 4] = -self.dt * x[5] * s, self.dt * x[5] * c
        F[:2, 5] = self.dt * c, self.dt * s
        return F

    def h_jacobian(self, x):
        c, s = np.cos(x[4]), np.sin(x[4])
        H = np.zeros((4, 6))
        H[[0, 1, 2, 3], [0, 1, 4, 5]] = 1
        H[:2, 4] = -self.forward * s - self.starboard * c, self.forward * c - self.starboard * s
        return H


def model_of(case):
    if case['name'] == 'linear':
        return Linear(case)
    return Towfish(case['turn_rate'], case['dt'], case['time_constant'], case['lever_arm'])
