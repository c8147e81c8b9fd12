# SPDX-License-Identifier: Apache-2.0
# Ceres is the independent reference of the Levenberg-Marquardt solver; tests only.
find_package(Ceres REQUIRED)
set(KINFER_TEST_LIBRARIES Ceres::ceres nlohmann_json::nlohmann_json)
