// SPDX-License-Identifier: Apache-2.0
// A sensor that turned looks like a changed joint: block by block a change of the joint has as many unknowns as one of
// the sensor, and explains it as well. But a turn is the same in all blocks, so whole rows tell them apart: the
// likelihood of a filter with an unknown turn of the sensor's mounting against that of one which doubts the joint.
#pragma once

#include <optional>
#include <span>

#include "kinfer/track/filter/chain_filter.hpp"

namespace kinfer::track {

/// The sensor next to the joint whose turn within `rows` makes them likelier than a change of the joint. `before`: the
/// filter before them.
std::optional<std::size_t> turned_beside(const ChainFilter& before, std::span<const BlockMeasurement> rows,
                                         std::size_t joint);

}  // namespace kinfer::track
