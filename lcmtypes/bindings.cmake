# Bindings of the wire contract for programs of others: C with publish and subscribe (a static library), C++, Python.
set(bindings ${CMAKE_CURRENT_BINARY_DIR}/bindings)
list(TRANSFORM HITCHVIEW_LCM_TYPES PREPEND ${bindings}/c/ OUTPUT_VARIABLE binding_sources)
list(TRANSFORM binding_sources APPEND .c)
# Which files there are of C++ and Python, the types themselves say; a type that is gone must leave none behind.
add_custom_command(
    OUTPUT ${binding_sources}
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${bindings}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${bindings}/c ${bindings}/include ${bindings}/python
    COMMAND ${LCM_GEN} -c --c-cpath ${bindings}/c --c-hpath ${bindings}/include ${lcm_files}
    COMMAND ${LCM_GEN} -x --cpp-hpath ${bindings}/include ${lcm_files}
    COMMAND ${LCM_GEN} -p --ppath ${bindings}/python ${lcm_files}
    DEPENDS ${lcm_files}
    COMMENT "Generating bindings of the LCM types")
add_library(hitchview_lcm_bindings STATIC ${binding_sources})
target_include_directories(hitchview_lcm_bindings SYSTEM PRIVATE ${bindings}/include ${LCM_INCLUDE_DIR})
set_target_properties(hitchview_lcm_bindings PROPERTIES OUTPUT_NAME hitchview-lcmtypes)
