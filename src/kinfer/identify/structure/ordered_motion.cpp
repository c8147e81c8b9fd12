// SPDX-License-Identifier: Apache-2.0
#include "kinfer/identify/structure/ordered_motion.hpp"

namespace kinfer::identify {

void align_headings(RecordedMotion& motion, const SegmentTree& tree) {
  std::vector<LinearHeading> headings(motion.segments.size());
  for (const std::size_t child : tree.order) {
    if (!tree.parent[child]) continue;
    const std::size_t parent = *tree.parent[child];
    const PairFit& pair = tree.pair(parent, child);
    const double sign = pair.first == parent ? 1.0 : -1.0;
    LinearHeading& heading = headings[child];
    heading.middle = pair.heading.middle;
    const LinearHeading& of_parent = headings[parent];
    heading.angle = of_parent.angle + of_parent.drift * (heading.middle - of_parent.middle) + sign * pair.heading.angle;
    heading.drift = of_parent.drift + sign * pair.heading.drift;
    heading.steps = of_parent.steps;
    for (const HeadingStep& step : pair.heading.steps) heading.steps.push_back({step.time, sign * step.angle});
    turn(motion.segments[child], motion.time, heading);
  }
}

Result<OrderedMotion> order_segments(const InsRecording& recording, const SegmentMotionOptions& options,
                                     const std::optional<std::string>& root, int threads,
                                     const std::vector<GivenLink>& given) {
  const HeadingSource headings = filter_of(options.filter).heading_source;
  KINFER_TRY(motion, headings == HeadingSource::filter ? segment_motion(recording, options, threads)
                                                       : gyro_based_motion(recording, options, threads));
  const HeadingReference reference =
      all_have_magnetometers(recording) ? HeadingReference::magnetometers : HeadingReference::arbitrary;
  KINFER_TRY(tree, segment_tree(motion, root, reference, threads));
  std::vector<Finding> findings;
  if (!given.empty()) {
    const std::vector<std::string> names = segment_names(motion);
    KINFER_TRY(given_result, given_tree(tree, names, given));
    findings = findings_about(given_result, tree, names);
    tree = given_result;
  }
  if (headings == HeadingSource::gyro) align_headings(motion, tree);
  return OrderedMotion{std::move(motion), std::move(tree), std::move(findings)};
}

}  // namespace kinfer::identify
