# What every target of this project shares: language, warnings, sanitizers, where things are put.
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(SLAMOT_PLUGIN_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib/slamot/plugins)
set(SLAMOT_PLUGIN_INSTALL_DIR ${CMAKE_INSTALL_LIBDIR}/slamot/plugins)
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR};$ORIGIN;$ORIGIN/../..")

find_package(Eigen3 REQUIRED NO_MODULE)
find_package(mrpt-obs REQUIRED)
find_package(mrpt-maps REQUIRED)
find_package(mrpt-system REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)

# Flags for code compiled here; never exported to users of the installed package.
add_library(slamot_build_flags INTERFACE)
target_compile_options(slamot_build_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow)
if(SLAMOT_WARNINGS_AS_ERRORS)
  target_compile_options(slamot_build_flags INTERFACE -Werror)
endif()
if(SLAMOT_CHECK_JOINT)
  add_compile_definitions(SLAMOT_CHECK_JOINT)
endif()
if(SLAMOT_SANITIZE)
  add_compile_options(-fsanitize=${SLAMOT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${SLAMOT_SANITIZE})
  # Under sanitizers Eigen pads its allocations by hand, MRPT's packages do not: memory taken by an inline function of
  # theirs and freed by ours would be freed in another way.
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()

# slamot_add_library(NAME SOURCES ... PUBLIC targets... PRIVATE targets...)
# One library of libs/: slamot_<name>, seen as slamot::<name> here and by users of the installed package.
function(slamot_add_library NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(slamot_${NAME} SHARED ${ARG_SOURCES})
  add_library(slamot::${NAME} ALIAS slamot_${NAME})
  set_target_properties(slamot_${NAME} PROPERTIES EXPORT_NAME ${NAME} VERSION ${PROJECT_VERSION}
                                                  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  target_include_directories(slamot_${NAME} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
                                                   $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(slamot_${NAME} PUBLIC cxx_std_17)
  target_link_libraries(slamot_${NAME} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:slamot_build_flags>)
  target_link_options(slamot_${NAME} PRIVATE -Wl,-z,defs)
  install(TARGETS slamot_${NAME} EXPORT slamot LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endfunction()
