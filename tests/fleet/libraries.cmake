# SPDX-License-Identifier: Apache-2.0
set(KINFER_TEST_LIBRARIES nlohmann_json::nlohmann_json)
