// Options of a verb, as a thin face of CLI11: that header costs ten seconds a file, so one file alone includes it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace kinfer::cli {

enum class Need { optional, required };

/// A verb of the program with its help text; `footer` shows an example.
CLI::App* add_command(CLI::App& program, const std::string& name, const std::string& summary,
                      const std::string& footer);

// Each binds `value`, which must live until the verb runs; its present content is the default that the help shows.
void add_text(CLI::App& verb, const std::string& name, std::string& value, const std::string& help,
              Need need = Need::optional, const std::string& placeholder = "TEXT");
void add_texts(CLI::App& verb, const std::string& name, std::vector<std::string>& values, const std::string& help,
               Need need = Need::optional, const std::string& placeholder = "TEXT");
void add_choice(CLI::App& verb, const std::string& name, std::string& value, const std::vector<std::string>& allowed,
                const std::string& help);
void add_count(CLI::App& verb, const std::string& name, int& value, int lowest, int highest, const std::string& help);
void add_number(CLI::App& verb, const std::string& name, double& value, const std::string& help);
void add_number(CLI::App& verb, const std::string& name, double& value, double lowest, double highest,
                const std::string& help);
/// A number that counts only where it was given.
void add_number(CLI::App& verb, const std::string& name, double& value, bool& given, const std::string& help);
void add_seed(CLI::App& verb, const std::string& name, std::uint64_t& value, const std::string& help);
void add_flag(CLI::App& verb, const std::string& name, bool& value, const std::string& help);

bool chosen(const CLI::App& verb);

}  // namespace kinfer::cli
