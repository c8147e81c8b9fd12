// SPDX-License-Identifier: Apache-2.0
// Parts that both reports share. Each function returns HTML.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "kinfer/evidence/facts/advice.hpp"
#include "kinfer/evidence/facts/records.hpp"
#include "kinfer/report/parts/html.hpp"

namespace kinfer::report {

std::string cards(const std::vector<std::pair<std::string, std::string>>& title_and_body);
std::string advice_list(const std::vector<Advice>& advice, std::size_t most);

/// Findings about the data; with a column for the rows that a finding concerns, or without.
enum class FindingRows { shown, hidden };
std::string findings_table(const std::vector<FindingRecord>& findings, FindingRows rows);

/// As a list; empty without notes.
std::string notes_list(const std::vector<std::string>& notes);

html::Section next_section(const std::vector<Advice>& advice);
html::Section repeat_section(const ProvenanceRecord& provenance);
html::Section glossary_section(const std::vector<std::pair<std::string, std::string>>& word_and_meaning);

/// Licences of the scripts in the page.
html::Section notices_section();

/// Cost against generation, best and median.
std::string convergence_plot(const std::vector<double>& best, const std::vector<double>& median,
                             const std::string& subject);

}  // namespace kinfer::report
