#include "kinfer/calibrate/verify.hpp"

#include <cmath>

#include "kinfer/calibrate/single_fit.hpp"
#include "kinfer/calibrate/surroundings.hpp"
#include "kinfer/estimate/residuals.hpp"

namespace kinfer {
namespace {

std::string in_millimetres(double metres) {
  return fmt::format("{:.3f} mm", 1e3 * metres);
}

double typical_sd(const Instrument& instrument, const PoseSet& data) {
  double squares = 0.0;
  for (const PointMeasurement& point : data.points) squares += std::pow(position_sd(instrument, point.position), 2);
  return std::sqrt(3.0 * squares / static_cast<double>(data.points.size()));
}

}  // namespace

Result<Verification> verify(const Chain& given_chain, const Tolerances& tolerances,
                            const std::optional<Instrument>& instrument, const PoseSet& given_data) {
  if (given_data.points.empty()) return error("the data hold no measured positions to verify against");
  KINFER_TRY(placed, with_surroundings(given_chain, given_data));
  const Chain& chain = placed.chain;
  const PoseSet data = with_approach(placed.data);
  Verification v;
  v.as_it_stands = error_statistics(point_errors(chain, data));
  KINFER_TRY(refitted, fit_frames_only({chain, tolerances, instrument, data}, data));
  v.frames_refitted = error_statistics(point_errors(refitted, data));

  constexpr double excuse = 3.0;  // times the scatter that the instrument promises
  const double excusable = instrument ? excuse * std::max(typical_sd(*instrument, data), 1e-8) : 0.0;
  const bool moved = v.frames_refitted.rms <= (instrument ? excusable : 0.5 * v.as_it_stands.rms);
  v.good = instrument ? v.as_it_stands.rms <= excusable : !moved;
  const std::string figures = fmt::format("the tool is {} off on average and {} at worst",
                                          in_millimetres(v.as_it_stands.mean), in_millimetres(v.as_it_stands.max));
  if (v.good)
    v.verdict = fmt::format("Still good: {}.", figures);
  else if (moved)
    v.verdict = fmt::format(
        "Not good as it stands: {}; with base and tool refitted {} on average, so the instrument or the "
        "tool was moved rather than the robot changed.",
        figures, in_millimetres(v.frames_refitted.mean));
  else
    v.verdict = fmt::format(
        "Not good any more: {}, more than the instrument can excuse, and refitting base and tool does not "
        "cure it ({}). Calibrate again.",
        figures, in_millimetres(v.frames_refitted.mean));
  return v;
}

}  // namespace kinfer
