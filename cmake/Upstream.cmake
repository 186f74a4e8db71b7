# SPDX-License-Identifier: AGPL-3.0-or-later
# Brings POV-Ray's source, with our hooks laid over it, to POVRAY_TREE at configure time; a changed
# hook configures again. All presets share one tree, and with ccache one compilation of what is the same.
set(POVRAY_TREE ${CMAKE_SOURCE_DIR}/build/upstream/tree)
option(POVRAY_HOOKS "OFF: upstream as it is, by the same compiler and flags, to compare with" ON)
if(NOT POVRAY_HOOKS)
	set(POVRAY_TREE ${CMAKE_SOURCE_DIR}/build/upstream/pristine)
endif()

file(GLOB_RECURSE hooks CONFIGURE_DEPENDS
	${CMAKE_SOURCE_DIR}/source/*.patch ${CMAKE_SOURCE_DIR}/vfe/*.patch ${CMAKE_SOURCE_DIR}/unix/*.patch)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${hooks} ${CMAKE_SOURCE_DIR}/tools/upstream)
execute_process(COMMAND ${CMAKE_SOURCE_DIR}/tools/upstream prepare ${POVRAY_SOURCE} RESULT_VARIABLE failed)
if(failed)
	message(FATAL_ERROR "POV-Ray's source could not be prepared; the line above says why")
endif()

# The libraries POV-Ray needs. Named in one go, so that a machine without a package manager
# is told everything that is missing at once.
set(missing "")
macro(need package debian)
	find_package(${package} ${ARGN})
	if(NOT ${package}_FOUND)
		string(APPEND missing " ${debian}")
	endif()
endmacro()
find_package(Threads REQUIRED)
need(Boost "libboost-thread-dev libboost-date-time-dev libboost-system-dev" 1.74 COMPONENTS thread date_time system)
need(PNG libpng-dev)
need(JPEG libjpeg-dev)
need(TIFF libtiff-dev)
need(ZLIB zlib1g-dev)
need(SDL libsdl1.2-dev)
# The farm's.
need(CURL libcurl4-openssl-dev)
need(OpenSSL libssl-dev)
need(SQLite3 libsqlite3-dev)
need(nlohmann_json nlohmann-json3-dev QUIET)
# OpenEXR's own CMake file fails where its Python module is not installed.
find_path(OPENEXR_INCLUDE OpenEXRConfig.h PATH_SUFFIXES OpenEXR)
find_path(IMATH_INCLUDE ImathConfig.h PATH_SUFFIXES Imath)
find_library(OPENEXR_LIBRARY NAMES OpenEXR OpenEXR-3_1)
find_library(IMATH_LIBRARY NAMES Imath Imath-3_1)
find_library(IEX_LIBRARY NAMES Iex Iex-3_1)
if(NOT OPENEXR_INCLUDE OR NOT IMATH_INCLUDE OR NOT OPENEXR_LIBRARY OR NOT IMATH_LIBRARY OR NOT IEX_LIBRARY)
	string(APPEND missing " libopenexr-dev")
endif()
find_path(SECCOMP_INCLUDE seccomp.h)
find_library(SECCOMP_LIBRARY seccomp)
if(NOT SECCOMP_INCLUDE OR NOT SECCOMP_LIBRARY)
	string(APPEND missing " libseccomp-dev")
endif()
if(missing)
	message(FATAL_ERROR "These libraries are missing, by their Debian names:${missing}")
endif()

# Flags and definitions of everything that includes an upstream header.
add_library(povray-flags INTERFACE)
target_compile_definitions(povray-flags INTERFACE HAVE_CONFIG_H
	POVLIBDIR="${CMAKE_INSTALL_FULL_DATADIR}/povray-3.7" POVCONFDIR="${POVRAY_CONFDIR}" POVCONFDIR_BACKWARD="/etc")
target_compile_options(povray-flags INTERFACE -pipe -w -Wno-multichar -Wno-write-strings -fno-enforce-eh-specs)
target_include_directories(povray-flags INTERFACE
	${CMAKE_SOURCE_DIR}/source ${CMAKE_SOURCE_DIR}
	${CMAKE_BINARY_DIR}/unix ${POVRAY_TREE}/unix ${POVRAY_TREE}/vfe ${POVRAY_TREE}/vfe/unix
	${OPENEXR_INCLUDE} ${IMATH_INCLUDE} ${IMATH_INCLUDE}/..
	${POVRAY_TREE}/source ${POVRAY_TREE}/source/backend ${POVRAY_TREE}/source/base ${POVRAY_TREE}/source/frontend)
target_link_libraries(povray-flags INTERFACE Threads::Threads Boost::thread Boost::date_time Boost::system
	PNG::PNG JPEG::JPEG TIFF::TIFF ZLIB::ZLIB ${OPENEXR_LIBRARY} ${IMATH_LIBRARY} ${IEX_LIBRARY})
