// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What every filter promises, whatever its noise law.
#include <cmath>
#include <limits>

#include "sas_motion/filters/bank_kalman_filter.hpp"
#include "sas_motion/filters/calibrated_filter.hpp"
#include "sas_motion/filters/gated_kalman_filter.hpp"
#include "sas_motion/filters/gaussian_sum_filter.hpp"
#include "sas_motion/filters/mixture_kalman_filter.hpp"
#include "sas_motion/filters/robust_kalman_filter.hpp"
#include "sas_motion/filters/student_t_kalman_filter.hpp"
#include "support.hpp"

namespace sas_motion {
namespace {

using testing::announced;

RobustKalmanFilter<6>::Options robust(LossKind kind, bool process = false) {
  RobustKalmanFilter<6>::Options options;
  options.loss = Loss(kind);
  options.robustify_process = process;
  return options;
}

struct Kf : KalmanFilter<6> {};
struct Bank : BankKalmanFilter<6> {
  Bank() : BankKalmanFilter(Options{}) {}
};
struct Gated : GatedKalmanFilter<6> {
  Gated() : GatedKalmanFilter(Options{}) {}
};
struct Mixture : MixtureKalmanFilter<6> {
  Mixture() : MixtureKalmanFilter(Options{}) {}
};
struct Sum : GaussianSumFilter<6> {
  Sum() : GaussianSumFilter(options()) {}
  static GaussianSumOptions options() {
    GaussianSumOptions options;
    options.measurement = {{1, 0.9, 0}, {100, 0.1, 0}};
    options.process = {{1, 0.95, 0}, {100, 0.05, 0}};
    return options;
  }
};
struct StudentT : StudentTKalmanFilter<6> {
  StudentT() : StudentTKalmanFilter(Options{}) {}
};
struct Huber : RobustKalmanFilter<6> {
  Huber() : RobustKalmanFilter(robust(LossKind::Huber)) {}
};
struct Tukey : RobustKalmanFilter<6> {
  Tukey() : RobustKalmanFilter(robust(LossKind::Tukey)) {}
};
struct HuberBoth : RobustKalmanFilter<6> {
  HuberBoth() : RobustKalmanFilter(robust(LossKind::Huber, true)) {}
};

struct CalibratedHuber : CalibratedFilter<RobustKalmanFilter<6>, 6> {
  CalibratedHuber() : CalibratedFilter(Huber()) {}
};
struct CalibratedTukey : CalibratedFilter<RobustKalmanFilter<6>, 6> {
  CalibratedTukey() : CalibratedFilter(Tukey()) {}
};
struct CalibratedStudentT : CalibratedFilter<StudentTKalmanFilter<6>, 6> {
  CalibratedStudentT() : CalibratedFilter(StudentT()) {}
};

template <class Filter>
class EveryFilter : public ::testing::Test {
 protected:
  using Belief = typename Filter::Belief;
  Filter filter;

  template <int M>
  void expectRefused(const Gaussian<6>& prior, const LinearMeasurement<6, M>& z, const char* what) {
    const auto update = filter.update(Belief{prior}, z);
    EXPECT_EQ(update.verdict, Verdict::Invalid) << what;
    EXPECT_EQ(gaussian(update.belief).mean, prior.mean) << what;
    EXPECT_EQ(gaussian(update.belief).covariance, prior.covariance) << what;
  }
};

using Filters = ::testing::Types<Kf, Bank, Gated, Mixture, StudentT, Huber, Tukey, HuberBoth, CalibratedHuber,
                                 CalibratedTukey, CalibratedStudentT, Sum>;
TYPED_TEST_SUITE(EveryFilter, Filters);

TYPED_TEST(EveryFilter, RefusesWhatIsNoMeasurementAndStaysAtThePrior) {
  Random random = announced(21);
  const auto prior = testing::randomBelief<6>(random);
  const auto one = testing::randomMeasurement<6, 1>(random);
  const auto two = testing::randomMeasurement<6, 2>(random);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf}) {
    auto z = one;
    z.innovation(0) = bad;
    this->expectRefused(prior, z, "innovation");
    auto pair = two;
    pair.innovation(1) = bad;
    this->expectRefused(prior, pair, "innovation of two");
    pair = two;
    pair.H(1, 3) = bad;
    this->expectRefused(prior, pair, "H");
  }
  for (const double bad : {nan, 0.0, -0.01, -1e6}) {
    auto z = one;
    z.R(0, 0) = bad;
    if (bad == 0) z.H.setZero();  // S = 0
    this->expectRefused(prior, z, "R");
    auto pair = two;
    pair.R(1, 1) = bad;
    if (bad == 0) pair.H.row(1).setZero();
    this->expectRefused(prior, pair, "R of two");
  }
}

TYPED_TEST(EveryFilter, RefusesACovarianceThatIsNone) {
  Random random = announced(22);
  auto prior = testing::randomBelief<6>(random);
  prior.covariance(0, 0) = -100;
  auto z = testing::randomMeasurement<6, 1>(random);
  z.H << 1, 0, 0, 0, 0, 0;  // S is negative
  this->expectRefused(prior, z, "negative variance");
}

TYPED_TEST(EveryFilter, CovarianceStaysSymmetricAndPositiveOverLongRunsOfPreciseMeasurements) {
  Random random = announced(23);
  typename TypeParam::Belief belief{Gaussian<6>{Vector<6>::Zero(), 100 * Matrix<6>::Identity()}};
  Transition<6> step{Vector<6>::Zero(), Matrix<6>::Identity(), 1e-12 * Matrix<6>::Identity()};
  for (int i = 0; i < 3000; ++i) {
    step.mean = gaussian(belief).mean;
    belief = this->filter.predict(belief, step);
    auto z = testing::randomMeasurement<6, 2>(random);
    z.R = 1e-10 * Matrix<2>::Identity();
    z.innovation = 1e-5 * testing::randomMatrix<2>(random) - z.H * gaussian(belief).mean;  // truth is zero
    const auto update = this->filter.update(belief, z);
    ASSERT_NE(update.verdict, Verdict::Invalid) << "step " << i;
    belief = update.belief;
    const Matrix<6>& P = gaussian(belief).covariance;
    ASSERT_EQ(P, Matrix<6>(P.transpose())) << "step " << i;
    ASSERT_GT(testing::smallestEigenvalue<6>(P), 0) << "step " << i;
  }
}

TYPED_TEST(EveryFilter, UnitsDoNotMatter) {
  Random random = announced(24);
  Vector<6> scale;
  scale << 1000, 1, 1e-3, 1, 1000, 1;
  const Vector<2> rows(1000, 1e-3);
  const Matrix<6> T = scale.asDiagonal(), T_inverse = scale.cwiseInverse().asDiagonal();
  for (int i = 0; i < 20; ++i) {
    auto prior = testing::randomBelief<6>(random);
    prior.covariance =
        prior.covariance.diagonal().asDiagonal();  // the symmetric root of a scaled full matrix is another root
    auto z = testing::randomMeasurement<6, 2>(random);
    z.innovation *= 8;
    auto scaled = z;
    scaled.innovation = rows.cwiseProduct(z.innovation);
    scaled.H = rows.asDiagonal() * z.H * T_inverse;
    scaled.R = rows.asDiagonal() * z.R * rows.asDiagonal();
    const Gaussian<6> scaled_prior{T * prior.mean, T * prior.covariance * T};
    const auto plain = this->filter.update({prior}, z);
    const auto other = this->filter.update({scaled_prior}, scaled);
    EXPECT_LT(testing::relativeDifference(T_inverse * gaussian(other.belief).mean, gaussian(plain.belief).mean), 1e-6);
    EXPECT_LT(testing::relativeDifference(T_inverse * gaussian(other.belief).covariance * T_inverse,
                                          gaussian(plain.belief).covariance),
              1e-6);
    EXPECT_NEAR(other.nis, plain.nis, 1e-9 * plain.nis);
    EXPECT_LT((other.weights - plain.weights).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_EQ(other.verdict, plain.verdict);
  }
}

TYPED_TEST(EveryFilter, WeightsLieBetweenNothingAndEverything) {
  Random random = announced(25);
  for (int i = 0; i < 200; ++i) {
    auto z = testing::randomMeasurement<6, 4>(random);
    z.innovation *= std::pow(10.0, 4 * random.uniform() - 2);
    const auto update = this->filter.update({testing::randomBelief<6>(random)}, z);
    EXPECT_GE(update.weights.minCoeff(), 0);
    EXPECT_LE(update.weights.maxCoeff(), 1);
    EXPECT_TRUE(gaussian(update.belief).mean.allFinite());
  }
}

TYPED_TEST(EveryFilter, AMeasurementAsPredictedMovesNothingAndAddsKnowledge) {
  Random random = announced(26);
  const auto prior = testing::randomBelief<6>(random);
  auto z = testing::randomMeasurement<6, 2>(random);
  z.innovation.setZero();
  const auto update = this->filter.update({prior}, z);
  EXPECT_LT((gaussian(update.belief).mean - prior.mean).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_GE(testing::smallestEigenvalue<6>(prior.covariance - gaussian(update.belief).covariance), -1e-12);
  EXPECT_EQ(update.verdict, Verdict::Accepted);
}

}  // namespace
}  // namespace sas_motion
