# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""filterpy's Kalman, cubature and unscented filters on a case of filter_answers. A peer's `step(z)` returns mean and covariance before and after z."""
import numpy as np
from filterpy.kalman import CubatureKalmanFilter, ExtendedKalmanFilter, KalmanFilter, MerweScaledSigmaPoints, UnscentedKalmanFilter
from filterpy.kalman.CubatureKalmanFilter import spherical_radial_sigmas

from .models import Linear


def started(filter_, case, column):
    filter_.x = np.array(case['start']['mean'])
    if column:
        filter_.x = filter_.x[:, np.newaxis]
    filter_.P, filter_.Q, filter_.R = np.array(case['start']['covariance']), np.array(case['Q']), np.array(case['R'])
    return filter_


def answer(filter_):
    return filter_.x_prior.ravel(), filter_.P_prior, filter_.x.ravel(), filter_.P


def kf(case, model, _):
    if isinstance(model, Linear):
        linear = started(KalmanFilter(6, 4), case, column=False)
        linear.F, linear.H = model.F, model.H

        def linear_step(z):
            linear.predict()
            linear.update(z)
            return answer(linear)
        return linear_step

    extended = started(ExtendedKalmanFilter(6, 4), case, column=False)

    def predict_x(_=0):  # filterpy's hook for a bent f: F is set here too, at the state that it starts from
        extended.F = model.f_jacobian(extended.x)
        extended.x = model.f(extended.x)
    extended.predict_x = predict_x

    def extended_step(z):
        extended.predict()
        extended.update(z, model.h_jacobian, model.h)
        return answer(extended)
    return extended_step


# filterpy sends the points of the prediction on through h. They lack the process noise, so that its cross covariance is that of f(x) alone. Redrawn
# from the predicted mean and covariance they give the filter that the papers, Stone Soup and we have.

def ckf(case, model, _):
    filter_ = started(CubatureKalmanFilter(6, 4, case.get('dt', 0), hx=model.h, fx=lambda x, dt: model.f(x)), case, column=True)

    def step(z):
        filter_.predict()
        filter_.sigmas_f = spherical_radial_sigmas(filter_.x, filter_.P)
        filter_.update(z[:, np.newaxis])
        return answer(filter_)
    return step


def ukf(case, model, unscented):
    points = MerweScaledSigmaPoints(6, **unscented)
    filter_ = started(UnscentedKalmanFilter(6, 4, case.get('dt', 0), hx=model.h, fx=lambda x, dt: model.f(x), points=points), case, column=False)

    def step(z):
        filter_.predict()
        filter_.sigmas_f = points.sigma_points(filter_.x, filter_.P)
        filter_.update(z)
        return answer(filter_)
    return step


FILTERS = {'kf': kf, 'ckf': ckf, 'ukf': ukf}
