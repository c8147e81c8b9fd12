// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/parts/model_patch_output.hpp"

#include <fmt/format.h>

#include "kinfer/base/constants.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/words/calibration/model_patch.hpp"

namespace kinfer::cli {

Result<void> check_offsets(bool given, const RobotModel& robot) {
  if (!given || robot.source) return {};
  return error("--offsets has no effect here: only a URDF or MJCF file is written back");
}

std::optional<ModelPatch> write_model_patch(OutputFolder& folder, const RobotModel& robot,
                                            const Calibration& calibration, EncoderOffsets offsets) {
  if (!robot.source) return std::nullopt;
  auto model = patch_model(robot, calibration, offsets);
  Result<void> done;
  if (!model) done = forward_error(model.error());
  for (std::size_t i = 0; done && i < model->files.size(); ++i)
    done = write_text_file(folder / model->files[i].name, model->files[i].text);
  if (done) return std::move(model->patch);
  print_message("kinfer: the robot file is not written back: {}\n", done.error().what);
  return std::nullopt;
}

std::string model_patch_summary(const ModelPatch& patch) {
  std::string text = words::headline(patch) + "\n";
  const bool separate = patch.offsets == EncoderOffsets::separate;
  if (!patch.changes.empty())
    text += fmt::format("  {:<28} {:>5} {:>26} {:>26}{}\n", "joint", "line", "moved by x, y, z [mm]",
                        "turned about x, y, z [deg]", separate ? "         offset" : "");
  for (const OriginChange& change : patch.changes) {
    const Vec3 mm = 1e3 * change.translation, turn = change.rotation_vector / degree;
    text += fmt::format("  {:<28} {:>5} {:>+8.3f} {:>+8.3f} {:>+8.3f} {:>+8.4f} {:>+8.4f} {:>+8.4f}", change.joint,
                        change.line, mm.x(), mm.y(), mm.z(), turn.x(), turn.y(), turn.z());
    if (separate)
      text += fmt::format(" {:>+10.4f} {}", change.translates ? 1e3 * change.offset : change.offset / degree,
                          change.translates ? "mm" : "deg");
    text += "\n";
  }
  for (const std::string& sentence : words::remarks(patch)) text += "  - " + sentence + "\n";
  return text;
}

}  // namespace kinfer::cli
