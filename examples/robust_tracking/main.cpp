// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tracks a target in the plane from readings of its position, of which one in ten is twenty times too noisy.
#include <cmath>
#include <cstdio>
#include <sas_motion/filters/robust_kalman_filter.hpp>
#include <sas_motion/math/random.hpp>

using namespace sas_motion;
constexpr double kStep = 1, kAcceleration = 0.02, kSigma = 1;  // [s], [m/s^2] an epoch, [m]
constexpr int kEpochs = 2000;

int main() {
  Matrix<4> F = Matrix<4>::Identity();  // of position and velocity, x before y
  F.topRightCorner<2, 2>() = kStep * Matrix<2>::Identity();
  Matrix<4, 2> push;  // what an acceleration does to the state
  push << 0.5 * kStep * kStep * Matrix<2>::Identity(), kStep * Matrix<2>::Identity();
  const Matrix<4> Q = kAcceleration * kAcceleration * push * push.transpose();
  const Matrix<2, 4> H = Matrix<2, 4>::Identity();
  const Matrix<2> R = kSigma * kSigma * Matrix<2>::Identity();

  const KalmanFilter<4> plain;
  const RobustKalmanFilter<4> robust{RobustKalmanOptions()};
  Vector<4> truth{0, 0, 2, 1};
  Gaussian<4> plain_belief{truth, Matrix<4>::Identity()}, robust_belief = plain_belief;
  double plain_squares = 0, robust_squares = 0;
  Random random(1);
  const auto draw = [&random] { return Vector<2>(random.gaussian(), random.gaussian()); };

  for (int epoch = 0; epoch < kEpochs; ++epoch) {
    truth = F * truth + kAcceleration * push * draw();
    const Vector<2> z = H * truth + (random.bernoulli(0.1) ? 20 : 1) * kSigma * draw();
    const auto track = [&](const auto& filter, Gaussian<4>& belief) {
      belief = filter.predict(belief, {F * belief.mean, F, Q});
      belief = filter.update(belief, LinearMeasurement<4, 2>{z - H * belief.mean, H, R}).belief;
      return (belief.mean - truth).head<2>().squaredNorm();
    };
    plain_squares += track(plain, plain_belief);
    robust_squares += track(robust, robust_belief);
  }
  std::printf("RMSE of the position: Kalman filter %.2f m, robust_kf %.2f m\n", std::sqrt(plain_squares / kEpochs),
              std::sqrt(robust_squares / kEpochs));
}
