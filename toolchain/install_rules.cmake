# What `cmake --install build/release --component C` installs. Components hitchview, tools and dev are the Debian packages hitchview,
# hitchview-tools and hitchview-dev (toolchain/debian). Where systemd and udev look does not depend on the prefix.
include(GNUInstallDirs)

install(TARGETS hitchview hitchview-web RUNTIME COMPONENT hitchview)
install(TARGETS hitchview-desk hitchview-view hitchview-eval hitchview-calib RUNTIME COMPONENT tools)

set(services ${PROJECT_SOURCE_DIR}/systemd)
install(DIRECTORY ${services}/system/ DESTINATION /lib/systemd/system COMPONENT hitchview)
install(DIRECTORY ${services}/udev/ DESTINATION /lib/udev/rules.d COMPONENT hitchview)
install(DIRECTORY ${services}/sysusers/ DESTINATION /usr/lib/sysusers.d COMPONENT hitchview)
install(DIRECTORY ${services}/tmpfiles/ DESTINATION /usr/lib/tmpfiles.d COMPONENT hitchview)
install(DIRECTORY ${services}/sysctl/ DESTINATION /usr/lib/sysctl.d COMPONENT hitchview)
install(DIRECTORY ${services}/sbin/ DESTINATION /usr/sbin USE_SOURCE_PERMISSIONS COMPONENT hitchview)
install(DIRECTORY ${services}/lib/ DESTINATION /usr/lib/hitchview USE_SOURCE_PERMISSIONS COMPONENT hitchview)
install(DIRECTORY ${services}/etc/ DESTINATION /etc/hitchview COMPONENT hitchview)

# One file serves every program; bash looks for it under the program's name.
set(completions ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
foreach(program hitchview hitchview-web)
    install(FILES ${PROJECT_SOURCE_DIR}/toolchain/completion DESTINATION ${completions} RENAME ${program} COMPONENT hitchview)
endforeach()
foreach(program hitchview-desk hitchview-view hitchview-eval hitchview-calib)
    install(FILES ${PROJECT_SOURCE_DIR}/toolchain/completion DESTINATION ${completions} RENAME ${program} COMPONENT tools)
endforeach()

set(libraries lib/${CMAKE_LIBRARY_ARCHITECTURE})
set(bindings ${PROJECT_BINARY_DIR}/lcmtypes/bindings)
install(TARGETS hitchview_lcm_bindings ARCHIVE DESTINATION ${libraries} COMPONENT dev)
install(DIRECTORY ${bindings}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hitchview COMPONENT dev)
install(DIRECTORY ${bindings}/python DESTINATION ${CMAKE_INSTALL_DATADIR}/hitchview COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lcmtypes DESTINATION ${CMAKE_INSTALL_DATADIR}/hitchview COMPONENT dev FILES_MATCHING PATTERN *.lcm)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/hitchview-dev COMPONENT dev)
configure_file(${PROJECT_SOURCE_DIR}/toolchain/hitchview-lcmtypes.pc.in ${PROJECT_BINARY_DIR}/hitchview-lcmtypes.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/hitchview-lcmtypes.pc DESTINATION ${libraries}/pkgconfig COMPONENT dev)
