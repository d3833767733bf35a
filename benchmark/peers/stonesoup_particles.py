# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Stone Soup's bootstrap filter on a case of particle_answers, put together of its own parts; only the growth model, which it has not, is written here.

It resamples systematically below half the particles, as we do, and its updater hands out the particles after that, from which mean and variance are.
"""
import datetime

import numpy as np
from stonesoup.base import Property
from stonesoup.models.base import GaussianModel
from stonesoup.models.measurement.base import MeasurementModel
from stonesoup.models.measurement.nonlinear import Cartesian2DToBearing
from stonesoup.models.transition.base import TransitionModel
from stonesoup.models.transition.linear import CombinedLinearGaussianTransitionModel, ConstantVelocity
from stonesoup.predictor.particle import ParticlePredictor
from stonesoup.resampler.particle import ESSResampler
from stonesoup.types.array import CovarianceMatrix, StateVector, StateVectors
from stonesoup.types.detection import Detection
from stonesoup.types.hypothesis import SingleHypothesis
from stonesoup.types.state import ParticleState
from stonesoup.updater.particle import ParticleUpdater

from .growth import moved, seen

START = datetime.datetime(2026, 1, 1)
SECOND = datetime.timedelta(seconds=1)


class Gaussian(GaussianModel):
    """A model with noise of a constant variance."""
    variance: np.ndarray = Property()

    def covar(self, **_):
        return CovarianceMatrix(self.variance)


class GrowthTransition(Gaussian, TransitionModel):
    ndim_state = 1

    def function(self, state, noise=False, **_):
        k = round((state.timestamp - START) / SECOND) + 1
        return StateVectors(moved(np.asarray(state.state_vector), k)) + (self.rvs(state.state_vector.shape[1]) if noise else 0)


class GrowthMeasurement(Gaussian, MeasurementModel):
    ndim_meas = 1

    def function(self, state, noise=False, **_):
        return StateVectors(seen(np.asarray(state.state_vector)))


def growth(case):
    return GrowthTransition(variance=np.diag(case['Q'])), GrowthMeasurement(ndim_state=1, mapping=(0,), variance=np.diag(case['R']))


def bearings(case):
    density = case['Q'][1][1]
    return (CombinedLinearGaussianTransitionModel([ConstantVelocity(density), ConstantVelocity(density)]),
            Cartesian2DToBearing(ndim_state=4, mapping=(0, 2), noise_covar=CovarianceMatrix(np.diag(case['R']))))


MODELS = {'growth': growth, 'bearings': bearings}


def runner(case, particles):
    """A function that runs the filter with a seed and returns means and variances after each reading."""
    transition, sensor = MODELS[case['name']](case)
    predictor, updater = ParticlePredictor(transition), ParticleUpdater(sensor, ESSResampler())
    stamps = [START + (k + 1) * SECOND for k in range(len(case['readings']))]
    detections = [Detection(StateVector(z), timestamp=stamp, measurement_model=sensor) for z, stamp in zip(case['readings'], stamps)]

    def run(seed):
        np.random.seed(seed)  # what its models and resampler draw from
        drawn = np.random.multivariate_normal(case['start']['mean'], np.atleast_2d(case['start']['covariance']), particles).T
        state = ParticleState(StateVectors(drawn), log_weight=np.full(particles, -np.log(particles)), timestamp=START)
        means, variances = [], []
        for stamp, detection in zip(stamps, detections):
            state = updater.update(SingleHypothesis(predictor.predict(state, timestamp=stamp), detection))
            means.append(np.asarray(state.mean, dtype=float).ravel())
            variances.append(np.diag(np.asarray(state.covar, dtype=float)))
        return np.array(means), np.array(variances)
    return run
