# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Stone Soup's Kalman, cubature and unscented filters on a case of filter_answers. A peer's `step(z)` returns mean and covariance before and after z.

Stone Soup redraws its points for the update, as we do. Its default kappa is 3 - n, so ours is passed on. Its CKF hands one state at a time to a model, its
UKF all of them as columns: the models take both.
"""
import datetime

import numpy as np
from stonesoup.base import Property
from stonesoup.models.base import GaussianModel
from stonesoup.models.measurement.base import MeasurementModel
from stonesoup.models.measurement.linear import LinearGaussian
from stonesoup.models.transition.base import TransitionModel
from stonesoup.models.transition.linear import LinearGaussianTimeInvariantTransitionModel
from stonesoup.predictor import kalman as predictors
from stonesoup.types.array import CovarianceMatrix, StateVector, StateVectors
from stonesoup.types.detection import Detection
from stonesoup.types.hypothesis import SingleHypothesis
from stonesoup.types.state import GaussianState
from stonesoup.updater import kalman as updaters

from .models import Linear


class Bent(GaussianModel):
    """A function of the state with a constant noise covariance."""
    value: object = Property()
    slope: object = Property()
    noise: np.ndarray = Property()

    def function(self, state, noise=False, **_):
        values = self.value(np.asarray(state.state_vector, dtype=float))
        return StateVector(values) if values.shape[1] == 1 else StateVectors(values)

    def jacobian(self, state, **_):
        return self.slope(np.asarray(state.state_vector, dtype=float).ravel())

    def covar(self, **_):
        return CovarianceMatrix(self.noise)


class LinearSensor(LinearGaussian):
    """LinearGaussian picks states; ours also mixes them."""
    rows: np.ndarray = Property()

    def matrix(self, **_):
        return self.rows


class BentTransition(Bent, TransitionModel):
    ndim_state = 6


class BentMeasurement(Bent, MeasurementModel):
    ndim_meas = 4


def models_of(case, model):
    Q, R = np.array(case['Q']), np.array(case['R'])
    if isinstance(model, Linear):
        return (LinearGaussianTimeInvariantTransitionModel(transition_matrix=model.F, covariance_matrix=Q),
                LinearSensor(ndim_state=6, mapping=(0, 1, 2, 3), noise_covar=R, rows=model.H))
    return (BentTransition(value=model.f, slope=model.f_jacobian, noise=Q),
            BentMeasurement(ndim_state=6, mapping=tuple(range(6)), value=model.h, slope=model.h_jacobian, noise=R))


def stepper(case, predictor, updater):
    state = GaussianState(case['start']['mean'], CovarianceMatrix(case['start']['covariance']), timestamp=datetime.datetime(2026, 1, 1))

    def step(z):
        nonlocal state
        now = state.timestamp + datetime.timedelta(seconds=0.1)
        prior = predictor.predict(state, timestamp=now)
        state = updater.update(SingleHypothesis(prior, Detection(StateVector(z), timestamp=now)))
        return [np.asarray(a, dtype=float) for a in (prior.state_vector.ravel(), prior.covar, state.state_vector.ravel(), state.covar)]
    return step


def kf(case, model, _):
    transition, sensor = models_of(case, model)
    kind = '' if isinstance(model, Linear) else 'Extended'
    return stepper(case, getattr(predictors, f'{kind}KalmanPredictor')(transition), getattr(updaters, f'{kind}KalmanUpdater')(sensor))


def ckf(case, model, _):
    transition, sensor = models_of(case, model)
    return stepper(case, predictors.CubatureKalmanPredictor(transition), updaters.CubatureKalmanUpdater(sensor))


def ukf(case, model, unscented):
    transition, sensor = models_of(case, model)
    return stepper(case, predictors.UnscentedKalmanPredictor(transition, **unscented), updaters.UnscentedKalmanUpdater(sensor, **unscented))


FILTERS = {'kf': kf, 'ckf': ckf, 'ukf': ukf}
