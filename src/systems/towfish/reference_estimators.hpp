// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "systems/towfish/campaign.hpp"

namespace sas_motion::towfish {

/// The oracle of a run, which must outlive it: a Kalman filter that is told the variance of each draw of the process
/// noise. What it is told of a reading's comes with toldTheTruth(). Truth that is not drawn from the model has no such
/// draws; it then has the model's own noise.
std::unique_ptr<Estimator> makeOracle(const Campaign& campaign, const SimulatedRun& run);

/// A reading with the variance that it was drawn with.
Measurement toldTheTruth(const LabelledMeasurement& labelled);

/// The law-aware reference: told the position's law for all sensors, and which rows have its spells.
std::unique_ptr<Estimator> makeBayesReference(const Campaign& campaign, const Scenario& scenario);

}  // namespace sas_motion::towfish
