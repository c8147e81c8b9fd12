// Short gaps of a sensor closed by straight lines between their neighbours, so that a filter integrates over them.
#pragma once

#include "kinfer/measurement/ins_recording.hpp"

namespace kinfer {

/// The sensor with rates and specific forces that are missing, clipped (force) or spikes replaced by the line between
/// the sound readings beside them, and their marks taken off, where those are not farther apart than `longest` [s].
InsSensor bridged(const InsSensor& sensor, std::span<const double> time, double longest);

}  // namespace kinfer
