# SPDX-License-Identifier: AGPL-3.0-or-later
# `cmake --install build/release` puts povray, POV-Ray's includes and our scenes where POV-Ray looks for them;
# the target `uninstall` takes away what was put there. The user's povray.ini and povray.conf are left alone.
install(TARGETS povray bhfarm bhfarm-server bhfarm-worker RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS bhfarm-reads LIBRARY DESTINATION lib/bhfarm)
install(DIRECTORY ${POVRAY_TREE}/distribution/include ${POVRAY_TREE}/distribution/ini
	DESTINATION ${CMAKE_INSTALL_DATADIR}/povray-3.7)
install(DIRECTORY scenes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/povray-3.7/scenes/blackhole
	FILES_MATCHING PATTERN "*.pov" PATTERN "*.ini" PATTERN "include" EXCLUDE)
install(DIRECTORY scenes/include DESTINATION ${CMAKE_INSTALL_DATADIR}/povray-3.7)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/povray-blackhole)
# povray has the path of its includes compiled in.
install(CODE "
	if(NOT CMAKE_INSTALL_PREFIX STREQUAL \"${CMAKE_INSTALL_PREFIX}\")
		message(WARNING \"This povray looks for its includes below ${CMAKE_INSTALL_PREFIX}, not below \${CMAKE_INSTALL_PREFIX}: configure with -DCMAKE_INSTALL_PREFIX=\${CMAKE_INSTALL_PREFIX} and build again\")
	endif()
		set(ours \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}/povray\")
	find_program(other povray NO_CACHE)
	if(other AND NOT other STREQUAL ours)
		message(WARNING \"There is another povray, \${other}: which of the two a shell finds depends on its PATH; this one is \${ours}\")
	endif()")

add_custom_target(uninstall
	COMMAND ${CMAKE_COMMAND} -D MANIFEST=${CMAKE_BINARY_DIR}/install_manifest.txt -P ${CMAKE_SOURCE_DIR}/cmake/Uninstall.cmake
	COMMENT "Removing what cmake --install put in place")
