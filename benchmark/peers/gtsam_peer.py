# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The smoothing problem of smoother_answers in the Python GTSAM: a graph of custom factors, Levenberg-Marquardt. See SmoothingProblem for the cost."""
import time

import gtsam
import numpy as np

from .models import Towfish, wrap

ROW_OF = {'heading': 4, 'speed': 5}


def difference(y, x):
    d = y - x
    d[4] = wrap(d[4])
    return d


def prior_factor(prior):
    mean = np.array(prior['mean'])

    def error(this, values, jacobians):
        if jacobians is not None:
            jacobians[0] = np.eye(6)
        return difference(values.atVector(this.keys()[0]), mean)
    return gtsam.CustomFactor(gtsam.noiseModel.Gaussian.Covariance(np.array(prior['covariance'])), [0], error)


def motion_factor(k, node, time_constant):
    model = Towfish(node['turn_rate'], node['dt'], time_constant, (0, 0))

    def error(this, values, jacobians):
        before, after = (values.atVector(key) for key in this.keys())
        if jacobians is not None:
            jacobians[0], jacobians[1] = -model.f_jacobian(before), np.eye(6)
        return difference(after, model.f(before))
    return gtsam.CustomFactor(gtsam.noiseModel.Gaussian.Covariance(np.array(node['Q'])), [k - 1, k], error)


def row_factor(k, reading, row, huber):
    """One scalar row, with a weight of its own as in our cost: GTSAM gives a vector factor one weight."""
    model = Towfish(0, 0, 1, reading['lever_arm'])
    row_of_h = row if reading['sensor'] == 'position' else ROW_OF[reading['sensor']] - 2
    angle = reading['sensor'] == 'heading'

    def error(this, values, jacobians):
        x = values.atVector(this.keys()[0])
        if jacobians is not None:
            jacobians[0] = model.h_jacobian(x)[[row_of_h]]
        residual = model.h(x)[row_of_h] - reading['value'][row]
        return np.array([wrap(residual) if angle else residual])
    noise = gtsam.noiseModel.Robust.Create(gtsam.noiseModel.mEstimator.Huber.Create(huber),
                                           gtsam.noiseModel.Isotropic.Sigma(1, np.sqrt(reading['variance'][row])))
    return gtsam.CustomFactor(noise, [k], error)


def graph_of(problem):
    graph = gtsam.NonlinearFactorGraph()
    graph.add(prior_factor(problem['prior']))
    for k, node in enumerate(problem['nodes']):
        if k > 0:
            graph.add(motion_factor(k, node, problem['time_constant']))
        for reading in node['readings']:
            for row in range(2 if reading['sensor'] == 'position' else 1):
                graph.add(row_factor(k, reading, row, problem['huber']))
    return graph


def solve(problem):
    """The states at the optimum, a row each, the cost, and the seconds of Levenberg-Marquardt with batch.cpp's settings."""
    begin = time.process_time()
    graph, values = graph_of(problem), gtsam.Values()
    for k, node in enumerate(problem['nodes']):
        values.insert(k, np.array(node['initial']))
    params = gtsam.LevenbergMarquardtParams()
    params.setRelativeErrorTol(problem['tolerance'])
    params.setAbsoluteErrorTol(0)
    params.setlambdaInitial(1e-9)
    values = gtsam.LevenbergMarquardtOptimizer(graph, values, params).optimize()
    seconds = time.process_time() - begin
    for _ in range(problem['refinements']):  # as in smoother_answers.cpp
        values = values.retract(graph.linearize(values).optimize())
    return np.array([values.atVector(k) for k in range(len(problem['nodes']))]), graph.error(values), seconds
