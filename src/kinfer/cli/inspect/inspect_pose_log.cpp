// SPDX-License-Identifier: Apache-2.0
#include "kinfer/cli/inspect/inspect_pose_log.hpp"

#include <nlohmann/json.hpp>

#include "kinfer/cli/parts/common.hpp"
#include "kinfer/cli/parts/terminal.hpp"
#include "kinfer/io/files/text_file.hpp"
#include "kinfer/io/pose_set/foreign/pose_tables.hpp"
#include "kinfer/io/text/dump_json.hpp"

namespace kinfer::cli {
namespace {

std::string use_of(PoseTableKind kind) {
  return kind == PoseTableKind::joints ? "joint positions: pair, calibrate (--joints), predict"
                                       : "tool points: pair, calibrate (--measured)";
}

}  // namespace

bool is_pose_log(const std::string& file) {
  const auto text = read_text_file(file);
  return text && find_pose_table_format(*text);
}

int inspect_pose_log(const std::string& file, bool json) {
  const auto text = read_text_file(file);
  if (!text) return fail(text.error());
  const PoseTableFormat& format = *find_pose_table_format(*text);
  const auto found = format.read(*text, file, nullptr);
  if (!found) return fail(found.error());
  if (json) {
    const nlohmann::ordered_json out{{"file", file},
                                     {"kind", format.kind == PoseTableKind::joints ? "joint_log" : "tracker_file"},
                                     {"format", format.title},
                                     {"rows", found->table.line.size()},
                                     {"contents", found->contents},
                                     {"use", use_of(format.kind)},
                                     {"remarks", found->remarks}};
    print_data(dump_json(out) + "\n");
    return exit_done;
  }
  print_text("{}: {}, {} rows\n", file, format.title, found->table.line.size());
  std::string names;
  for (const std::string& name : found->contents) names += (names.empty() ? "" : ", ") + name;
  print_text("  {}: {}\n", format.kind == PoseTableKind::joints ? "joints" : "markers", names);
  print_text("  {}\n", use_of(format.kind));
  if (format.kind == PoseTableKind::points && found->contents.size() > 1)
    print_text("  --marker NAME says which is the tool point\n");
  for (const std::string& remark : found->remarks) print_text("! {}\n", remark);
  return exit_done;
}

}  // namespace kinfer::cli
