# slamot_add_plugin(NAME CLASS Class KIND estimator|detector ABOUT "one line" [SOURCES ...] [LIBS ...])
# One plugin module, libslamot_<name>.so, from <Class>.cpp and further SOURCES. Used in this tree and, through
# find_package(slamot), in others'.
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
  add_library(slamot_plugin_${NAME} MODULE ${ARG_CLASS}.cpp ${ARG_SOURCES} ${record})
  target_include_directories(slamot_plugin_${NAME} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(slamot_plugin_${NAME} PRIVATE slamot::core ${ARG_LIBS})
  if(TARGET slamot_build_flags)
    target_link_libraries(slamot_plugin_${NAME} PRIVATE slamot_build_flags)
  endif()
  # An undefined symbol must fail here and not at the first call in a user's run.
  target_link_options(slamot_plugin_${NAME} PRIVATE -Wl,-z,defs -Wl,-z,now)
  set_target_properties(slamot_plugin_${NAME} PROPERTIES OUTPUT_NAME slamot_${NAME} PREFIX lib)
  if(SLAMOT_PLUGIN_OUTPUT_DIRECTORY)
    set_target_properties(slamot_plugin_${NAME} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${SLAMOT_PLUGIN_OUTPUT_DIRECTORY})
  endif()
  install(TARGETS slamot_plugin_${NAME} LIBRARY DESTINATION ${SLAMOT_PLUGIN_INSTALL_DIR})
endfunction()
