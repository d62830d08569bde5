# What plugins need, in this tree and, through find_package(slamot), in others'.
include_guard()
include(GNUInstallDirs)

# slamot_add_plugin(NAME CLASS Class KIND estimator|detector ABOUT "one line" [SOURCES ...] [LIBS ...])
# One plugin module, libslamot_<name>.so, from <Class>.cpp and further SOURCES.
# It is put into SLAMOT_PLUGIN_OUTPUT_DIRECTORY, by default the build folder's slamot/plugins (name that folder in
# SLAMOT_PLUGIN_PATH to use it), and installed into SLAMOT_PLUGIN_INSTALL_DIR, by default where an installed slamot
# of the same prefix looks.
function(slamot_add_plugin NAME)
  cmake_parse_arguments(ARG "" "CLASS;KIND;ABOUT" "SOURCES;LIBS" ${ARGN})
  foreach(required CLASS KIND ABOUT)
    if(NOT ARG_${required})
      message(FATAL_ERROR "slamot_add_plugin(${NAME}): ${required} is missing")
    endif()
  endforeach()
  if(NOT ARG_KIND MATCHES "^(estimator|detector)$")
    message(FATAL_ERROR "slamot_add_plugin(${NAME}): KIND is estimator or detector, not '${ARG_KIND}'")
  endif()
  if(NOT NAME MATCHES "^[a-z][a-z0-9_]*$")
    message(FATAL_ERROR "slamot_add_plugin(${NAME}): a name has lower-case letters, digits and _ only")
  endif()
  if(NOT SLAMOT_PLUGIN_OUTPUT_DIRECTORY)
    set(SLAMOT_PLUGIN_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/slamot/plugins)
  endif()
  if(NOT SLAMOT_PLUGIN_INSTALL_DIR)
    set(SLAMOT_PLUGIN_INSTALL_DIR ${CMAKE_INSTALL_LIBDIR}/slamot/plugins)
  endif()

  set(record ${CMAKE_CURRENT_BINARY_DIR}/${NAME}_record.cpp)
  file(CONFIGURE OUTPUT ${record} @ONLY CONTENT [=[
#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>
#include <slamot/core/plugin/PluginRecord.h>

#include "@ARG_CLASS@.h"

SLAMOT_PLUGIN_RECORD("@NAME@", "slamot::@ARG_CLASS@", "@ARG_KIND@", "@ARG_ABOUT@");

MRPT_INITIALIZER(registerSlamotPlugin) {
    mrpt::rtti::registerClass(CLASS_ID_NAMESPACE(@ARG_CLASS@, slamot));
}
]=])
  set(target slamot_plugin_${NAME})
  add_library(${target} MODULE ${ARG_CLASS}.cpp ${ARG_SOURCES} ${record})
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE slamot::core ${ARG_LIBS})
  if(TARGET slamot_build_flags)
    target_link_libraries(${target} PRIVATE slamot_build_flags)
  endif()
  # An undefined symbol must fail here and not at the first call in a user's run.
  target_link_options(${target} PRIVATE -Wl,-z,defs -Wl,-z,now)
  set_target_properties(${target} PROPERTIES OUTPUT_NAME slamot_${NAME} PREFIX lib
                                             LIBRARY_OUTPUT_DIRECTORY ${SLAMOT_PLUGIN_OUTPUT_DIRECTORY})
  set_property(GLOBAL APPEND PROPERTY SLAMOT_PLUGIN_TARGETS ${target})
  install(TARGETS ${target} LIBRARY DESTINATION ${SLAMOT_PLUGIN_INSTALL_DIR})
endfunction()

# slamot_add_plugin_test(NAME SOURCES...)
# Outside slamot's own tree: the program test_<name> from SOURCES with slamot's laws for estimators
# (conformance/Conformance.h), run by ctest with the plugin of that name. Needs GoogleTest.
function(slamot_add_plugin_test NAME)
  find_package(GTest REQUIRED)
  file(GLOB laws ${SLAMOT_CONFORMANCE_DIR}/conformance/src/*.cpp)
  add_executable(test_${NAME} ${ARGN} ${laws})
  target_include_directories(test_${NAME} PRIVATE ${SLAMOT_CONFORMANCE_DIR})
  target_link_libraries(test_${NAME} PRIVATE slamot::core slamot::sim slamot::eval fmt::fmt GTest::gtest
                                             GTest::gmock GTest::gtest_main)
  add_dependencies(test_${NAME} slamot_plugin_${NAME})
  add_test(NAME ${NAME} COMMAND test_${NAME})
  set_tests_properties(${NAME} PROPERTIES ENVIRONMENT
    "SLAMOT_PLUGIN_PATH=$<TARGET_FILE_DIR:slamot_plugin_${NAME}>")
endfunction()
