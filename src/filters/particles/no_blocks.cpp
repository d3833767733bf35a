// SPDX-FileCopyrightText: 2026 The sas_motion authors
// SPDX-License-Identifier: BSD-3-Clause
//
// For builds without Highway: available() is false, so filters call none of the other functions.
#include <stdexcept>

#include "sas_motion/filters/particles/blocks.hpp"

namespace sas_motion::blocks {
namespace {

[[noreturn]] void refuse() { throw std::logic_error("sas_motion was built without Highway"); }

}  // namespace

bool available() { return false; }
const char* target() { return "none"; }
void spread(const double*, const double*, int, double*) { refuse(); }
void average(const double*, const double*, int, int, double*, double*) { refuse(); }
void addSquares(double*, int, double*, int) { refuse(); }
void condition(const Conditioning&) { refuse(); }
void addSecondMoments(const double*, const double*, const double*, int, double*) { refuse(); }

}  // namespace sas_motion::blocks
