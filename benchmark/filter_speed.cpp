// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Predict and update of all four channels: our filters beside a bare Eigen step written for this one case and OpenCV's
// filter.
#include <benchmark/benchmark.h>

#include <Eigen/Cholesky>

#include "sas_motion/filters/calibrated_filter.hpp"
#include "sas_motion/filters/gated_kalman_filter.hpp"
#include "sas_motion/filters/mixture_kalman_filter.hpp"
#include "sas_motion/filters/robust_kalman_filter.hpp"
#include "sas_motion/filters/student_t_kalman_filter.hpp"
#include "sas_motion/systems/towfish/model.hpp"
#ifdef SAS_MOTION_WITH_OPENCV
#include <opencv2/video/tracking.hpp>
#endif

namespace {

using namespace sas_motion;
using namespace sas_motion::towfish;

constexpr double kDt = 0.1;

Gaussian<kStates> start() {
  Gaussian<kStates> belief;
  belief.mean << 0, 0, 0.1, 0.1, 0.7, 2;
  belief.covariance.diagonal() << 0.05, 0.05, 0.01, 0.01, 1e-4, 1e-3;
  return belief;
}

/// All four channels as one measurement; every tenth has an outlier.
LinearMeasurement<kStates, 4> reading(int k) {
  LinearMeasurement<kStates, 4> z;
  z.H.setZero();
  z.H(0, kNorth) = z.H(1, kEast) = z.H(2, kHeading) = z.H(3, kSpeed) = 1;
  z.R = Vector<4>(1, 1, 7.6e-5, 2.5e-3).asDiagonal();
  const double sign = k % 2 == 0 ? 1 : -1;
  z.innovation << 0.6 * sign, k % 10 == 0 ? 12 : -0.4 * sign, 0.004 * sign, -0.03 * sign;
  return z;
}

template <class Filter>
void ours(benchmark::State& state, const Filter& filter) {
  const Model model{MotionParameters{}};
  typename Filter::Belief belief{start()};
  int k = 0;
  for (auto unused : state) {
    (void)unused;
    belief = filter.predict(belief, model.transition(gaussian(belief).mean, Input{}, kDt));
    const auto update = filter.update(belief, reading(++k));
    belief = update.belief;
    benchmark::DoNotOptimize(belief);
  }
}

/// The textbook step with the model's own F and Q, Joseph form, for six states and four rows and nothing else.
void bareEigen(benchmark::State& state) {
  const Model model{MotionParameters{}};
  auto belief = start();
  int k = 0;
  for (auto unused : state) {
    (void)unused;
    const auto step = model.transition(belief.mean, Input{}, kDt);
    const StateMatrix P = step.F * belief.covariance * step.F.transpose() + step.Q;
    const auto z = reading(++k);
    const Matrix<4> S = z.H * P * z.H.transpose() + z.R;
    const Matrix<kStates, 4> K = S.llt().solve(z.H * P).transpose();
    const StateMatrix A = StateMatrix::Identity() - K * z.H;
    belief.mean = step.mean + K * z.innovation;
    belief.covariance = A * P * A.transpose() + K * z.R * K.transpose();
    benchmark::DoNotOptimize(belief);
  }
}

#ifdef SAS_MOTION_WITH_OPENCV
/// OpenCV's filter with the same matrices in double precision; the model is evaluated for it too.
void openCv(benchmark::State& state) {
  const Model model{MotionParameters{}};
  cv::setNumThreads(1);
  cv::KalmanFilter filter(kStates, 4, 0, CV_64F);
  const auto belief = start();
  for (int i = 0; i < kStates; ++i) {
    filter.statePost.at<double>(i) = belief.mean(i);
    for (int j = 0; j < kStates; ++j) filter.errorCovPost.at<double>(i, j) = belief.covariance(i, j);
  }
  cv::Mat measurement(4, 1, CV_64F);
  int k = 0;
  for (auto unused : state) {
    (void)unused;
    const StateVector x = Eigen::Map<const StateVector>(filter.statePost.ptr<double>());
    const auto step = model.transition(x, Input{}, kDt);
    const auto z = reading(++k);
    for (int i = 0; i < kStates; ++i)
      for (int j = 0; j < kStates; ++j) {
        filter.transitionMatrix.at<double>(i, j) = step.F(i, j);
        filter.processNoiseCov.at<double>(i, j) = step.Q(i, j);
      }
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < kStates; ++j) filter.measurementMatrix.at<double>(i, j) = z.H(i, j);
      for (int j = 0; j < 4; ++j) filter.measurementNoiseCov.at<double>(i, j) = z.R(i, j);
    }
    const cv::Mat& predicted = filter.predict();
    for (int i = 0; i < 4; ++i)
      measurement.at<double>(i) =
          z.innovation(i) + (z.H.row(i) * Eigen::Map<const StateVector>(predicted.ptr<double>()))(0);
    filter.correct(measurement);
    benchmark::DoNotOptimize(filter.statePost);
  }
}
BENCHMARK(openCv)->Name("opencv");
#endif

RobustKalmanFilter<kStates>::Options onePass() {
  RobustKalmanFilter<kStates>::Options options;
  options.max_iterations = 1;
  return options;
}

template <class Filter>
using Calibrated = CalibratedFilter<Filter, kStates>;

BENCHMARK(bareEigen)->Name("bare_eigen");
BENCHMARK_CAPTURE(ours, kf, KalmanFilter<kStates>())->Name("kf");
BENCHMARK_CAPTURE(ours, gated_kf, GatedKalmanFilter<kStates>({}))->Name("gated_kf");
BENCHMARK_CAPTURE(ours, robust_kf, Calibrated<RobustKalmanFilter<kStates>>(RobustKalmanFilter<kStates>({})))
    ->Name("robust_kf");
BENCHMARK_CAPTURE(ours, robust_kf_not_calibrated, RobustKalmanFilter<kStates>({}))->Name("robust_kf_not_calibrated");
BENCHMARK_CAPTURE(ours, robust_kf_one_pass, RobustKalmanFilter<kStates>(onePass()))->Name("robust_kf_one_pass");
BENCHMARK_CAPTURE(ours, student_t_kf, Calibrated<StudentTKalmanFilter<kStates>>(StudentTKalmanFilter<kStates>({})))
    ->Name("student_t_kf");
BENCHMARK_CAPTURE(ours, mixture_kf, MixtureKalmanFilter<kStates>({}))->Name("mixture_kf");

}  // namespace

BENCHMARK_MAIN();
