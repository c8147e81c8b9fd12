# SPDX-License-Identifier: Apache-2.0
# What a package holds besides program, library and Python module: man pages and completions, made by the program from its
# own options. `cpack` in the build folder makes a tarball for systems without Debian's packages.
set(shell_files ${PROJECT_BINARY_DIR}/shell)
add_custom_command(OUTPUT ${shell_files}/stamp
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${shell_files}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${shell_files}
  COMMAND kinfer_program man --out ${shell_files}/man1
  COMMAND kinfer_program completion bash > ${shell_files}/kinfer
  COMMAND kinfer_program completion zsh > ${shell_files}/_kinfer
  COMMAND kinfer_program completion fish > ${shell_files}/kinfer.fish
  COMMAND ${CMAKE_COMMAND} -E touch ${shell_files}/stamp
  DEPENDS kinfer_program COMMENT "Writing man pages and completions" VERBATIM)
add_custom_target(kinfer_shell_files ALL DEPENDS ${shell_files}/stamp)
install(DIRECTORY ${shell_files}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} FILES_MATCHING PATTERN "*.1")
install(FILES ${shell_files}/kinfer DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${shell_files}/_kinfer DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES ${shell_files}/kinfer.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

set(CPACK_GENERATOR TGZ)
set(CPACK_PACKAGE_NAME kinfer)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_STRIP_FILES ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_VERBATIM_VARIABLES ON)
include(CPack)
