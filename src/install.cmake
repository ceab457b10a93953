# Installation: the command, both libraries, the headers, and what find_package(quoin) and pkg-config need.
# Both descriptions find the prefix from where they lie, so an installed tree may be moved.
if(NOT TARGET quoin_static)
  return()
endif()
include(CMakePackageConfigHelpers)

if(TARGET quoin)
  install(TARGETS quoin RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
install(TARGETS quoin_static quoin_shared EXPORT quoinTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY include/quoin DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.h")

# --- CMake: quoin::quoin (shared, or static where BUILD_SHARED_LIBS is off), quoin::shared, quoin::static -----------
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/quoin)
file(WRITE ${CMAKE_BINARY_DIR}/quoinConfig.cmake.in [=[
@PACKAGE_INIT@
include(CMakeFindDependencyMacro)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/quoinTargets.cmake)
# The static library does not carry its dependencies, so whoever links it needs their -dev packages too.
find_library(quoin_MPFR_LIBRARY mpfr)
find_library(quoin_GMP_LIBRARY gmp)
find_library(quoin_PNG_LIBRARY NAMES png png16)
mark_as_advanced(quoin_MPFR_LIBRARY quoin_GMP_LIBRARY quoin_PNG_LIBRARY)
if(quoin_MPFR_LIBRARY AND quoin_GMP_LIBRARY AND quoin_PNG_LIBRARY)
  set_property(TARGET quoin::static APPEND PROPERTY INTERFACE_LINK_LIBRARIES
    ${quoin_MPFR_LIBRARY} ${quoin_GMP_LIBRARY} ${quoin_PNG_LIBRARY} Threads::Threads m)
elseif(DEFINED BUILD_SHARED_LIBS AND NOT BUILD_SHARED_LIBS)
  set(quoin_FOUND FALSE)
  set(quoin_NOT_FOUND_MESSAGE "the static library needs mpfr, gmp and libpng; install their development packages")
endif()
if(NOT TARGET quoin::quoin)
  add_library(quoin::quoin INTERFACE IMPORTED)
  if(DEFINED BUILD_SHARED_LIBS AND NOT BUILD_SHARED_LIBS)
    set_property(TARGET quoin::quoin PROPERTY INTERFACE_LINK_LIBRARIES quoin::static)
  else()
    set_property(TARGET quoin::quoin PROPERTY INTERFACE_LINK_LIBRARIES quoin::shared)
  endif()
endif()
check_required_components(quoin)
]=])
configure_package_config_file(${CMAKE_BINARY_DIR}/quoinConfig.cmake.in ${CMAKE_BINARY_DIR}/quoinConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/quoinConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT quoinTargets NAMESPACE quoin:: DESTINATION ${package_dir})
install(FILES ${CMAKE_BINARY_DIR}/quoinConfig.cmake ${CMAKE_BINARY_DIR}/quoinConfigVersion.cmake DESTINATION ${package_dir})

# --- pkg-config: --static adds what the static library needs --------------------------------------------------------
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}" OR IS_ABSOLUTE "${CMAKE_INSTALL_INCLUDEDIR}")
  set(pc_prefix ${CMAKE_INSTALL_PREFIX})
  set(pc_libdir ${CMAKE_INSTALL_FULL_LIBDIR})
  set(pc_includedir ${CMAKE_INSTALL_FULL_INCLUDEDIR})
else()
  file(RELATIVE_PATH pc_up /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  string(REGEX REPLACE "/$" "" pc_up "${pc_up}")
  set(pc_prefix "\${pcfiledir}/${pc_up}")
  set(pc_libdir "\${prefix}/${CMAKE_INSTALL_LIBDIR}")
  set(pc_includedir "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
endif()
file(WRITE ${CMAKE_BINARY_DIR}/quoin.pc
"prefix=${pc_prefix}
libdir=${pc_libdir}
includedir=${pc_includedir}

Name: quoin
Description: ${PROJECT_DESCRIPTION}
Version: ${PROJECT_VERSION}
Requires.private: mpfr gmp libpng
Libs: -L\${libdir} -lquoin
Libs.private: -lm -pthread
Cflags: -I\${includedir}
")
install(FILES ${CMAKE_BINARY_DIR}/quoin.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
