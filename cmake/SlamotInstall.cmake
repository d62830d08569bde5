# The installed package: find_package(slamot) gives slamot::core, slamot::rawlog, slamot::sim, slamot::eval,
# slamot::run, slamot::report, slamot::study and the functions of SlamotAddPlugin.cmake. It may be moved as a whole.
include(CMakePackageConfigHelpers)

set(SLAMOT_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/slamot)
set(SLAMOT_DATA_DIR ${CMAKE_INSTALL_DATADIR}/slamot)

install(EXPORT slamot NAMESPACE slamot:: DESTINATION ${SLAMOT_PACKAGE_DIR} FILE slamotTargets.cmake)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/slamotConfig.cmake.in ${PROJECT_BINARY_DIR}/slamotConfig.cmake
  INSTALL_DESTINATION ${SLAMOT_PACKAGE_DIR} PATH_VARS SLAMOT_DATA_DIR NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Before 1.0 every minor version may change the plugin interface.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/slamotConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/slamotConfig.cmake ${PROJECT_BINARY_DIR}/slamotConfigVersion.cmake
              ${CMAKE_CURRENT_LIST_DIR}/SlamotAddPlugin.cmake
        DESTINATION ${SLAMOT_PACKAGE_DIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config DESTINATION ${SLAMOT_DATA_DIR})
# The laws third parties hold their plugins to with slamot_add_plugin_test(), with or without tests built here.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/tests/conformance DESTINATION ${SLAMOT_DATA_DIR}
        FILES_MATCHING PATTERN "*.h" PATTERN "*.cpp" PATTERN "selftest" EXCLUDE)
install(FILES ${PROJECT_SOURCE_DIR}/tests/support/Expect.h DESTINATION ${SLAMOT_DATA_DIR}/support)
