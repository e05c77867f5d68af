# Fails when a folder includes what it may not: cmake -D ROOT=<tree> -P toolchain/check_includes.cmake
# The rules are those of docs/adr/0001-folders-and-include-direction.md.
cmake_minimum_required(VERSION 3.22)

set(folders hal algo drivers calib app lcmtypes)

# Own headers: folder -> pattern of what it may include beside itself.
set(may_include_hal "^$")
set(may_include_algo "^$")
set(may_include_drivers "^(hal|lcmtypes)/")
set(may_include_drivers_simulated "^(hal|lcmtypes)/|^algo/(camera_model|unit)\\.hpp$")
set(may_include_calib "^algo/")
set(may_include_app "^(hal|drivers|algo|calib|lcmtypes)/")
set(may_include_lcmtypes "^$")

# Other people's headers, where they are restricted. Without an extension: the standard library's.
set(may_use_hal "^[a-z0-9_]+$")
set(may_use_algo "^[a-z0-9_]+$|^Eigen/|^opencv2/|^hwy/|^(immintrin|arm_neon)\\.h$")

# Where app may name a concrete driver: file -> pattern. What demo_verb.cpp may, bench_*, demo_*, scenario_*, simulated_* and truth_* may;
# log_files stands for log_*, web_files for web_*, record_files for what makes recordings.
set(drivers_in_app/await_verb.cpp "^drivers/lcm_subscriber\\.hpp$")
set(drivers_in_app/board.cpp "^drivers/")
set(drivers_in_app/calib_capture_source.cpp "^drivers/simulated_sheet\\.hpp$")
set(drivers_in_app/camera_probe.cpp "^drivers/v4l2_(camera|probe)\\.hpp$")
set(drivers_in_app/live_camera_options.hpp "^drivers/(libcamera_camera|v4l2_negotiation)\\.hpp$")
set(drivers_in_app/live_opening.cpp "^drivers/libcamera_camera\\.hpp$")
set(drivers_in_app/live_opening.hpp "^drivers/v4l2_camera\\.hpp$")
set(drivers_in_app/view_verb.cpp "^drivers/lcm_subscriber\\.hpp$")
set(drivers_in_app/web_files "^drivers/lcm_(image_message|listener|log_messages|logged_health|logged_overlay|url)\\.hpp$")
set(drivers_in_app/doctor_display.cpp "^drivers/lcm_url\\.hpp$")
set(drivers_in_app/doctor_lcm.cpp "^drivers/lcm_url\\.hpp$")
set(drivers_in_app/doctor_this_machine.cpp "^drivers/(lcm_(listener|receive_buffer|self_test)|socketcan_link)\\.hpp$")
set(drivers_in_app/demo_verb.cpp "^drivers/(looped_[a-z]+|simulated_[a-z_]+|steady_clock)\\.hpp$")
set(drivers_in_app/log_files "^drivers/lcm_log_[a-z_]+\\.hpp$")
set(drivers_in_app/record_files "^drivers/lcm_(encoder|log_writer|record_messages|url)\\.hpp$")
set(drivers_in_app/evaluation.cpp "^drivers/replay_camera\\.hpp$")

# 'Logged only': what these files reach, over any number of includes, has none of these headers.
set(estimating_files "^(algo/|app/(pipeline|frame_set|rig_geometry))")
set(telemetry_headers
    "^(hal/(hitch_angle|[a-z_]*can_bus)|drivers/(socketcan|candump|simulated_can|lcm_log_can)_[a-z_]+|app/(can|candump|dbc|hitch_angle|telemetry)_[a-z_]+)\\.hpp$")

set(complaints "")

function(complain place what)
    string(APPEND complaints "\n${place}: ${what}")
    set(complaints "${complaints}" PARENT_SCOPE)
endfunction()

# lcm_publisher.cpp and lcm_subscriber.hpp are of one family, `lcm`.
function(family_of file result)
    string(REGEX REPLACE "^drivers/([a-z0-9]+).*$" "\\1" family "${file}")
    set(${result} "${family}" PARENT_SCOPE)
endfunction()

function(check_other place folder header)
    if(DEFINED may_use_${folder} AND NOT header MATCHES "${may_use_${folder}}")
        complain("${place}" "${folder} may not include <${header}>")
        set(complaints "${complaints}" PARENT_SCOPE)
    endif()
endfunction()

# What several drivers share is of the family `frame`, which includes no other.
function(check_driver place file header)
    family_of("${file}" own_family)
    family_of("${header}" family)
    if(NOT family STREQUAL own_family AND NOT family STREQUAL "frame")
        complain("${place}" "driver ${own_family} may not include another driver, ${header}")
        set(complaints "${complaints}" PARENT_SCOPE)
    endif()
endfunction()

function(check_own place file folder header)
    set(rule "${may_include_${folder}}")
    if(file MATCHES "^drivers/simulated_")
        set(rule "${may_include_drivers_simulated}")
    endif()
    if(folder STREQUAL "drivers" AND header MATCHES "^drivers/")
        check_driver("${place}" "${file}" "${header}")
    elseif(folder STREQUAL "app" AND header MATCHES "^drivers/")
        string(REGEX REPLACE "^app/(bench|demo|scenario|simulated|truth)_[a-z_]+\\.[ch]pp$" "app/demo_verb.cpp" program "${file}")
        string(REGEX REPLACE "^app/log_[a-z_]+\\.[ch]pp$" "app/log_files" program "${program}")
        string(REGEX REPLACE "^app/web_[a-z_]+\\.[ch]pp$" "app/web_files" program "${program}")
        string(REGEX REPLACE "^app/(frame_recorder|publish_options|record(er|_[a-z_]+|ing_[a-z_]+))\\.[ch]pp$" "app/record_files"
            program "${program}")
        if(NOT DEFINED drivers_in_${program} OR NOT header MATCHES "${drivers_in_${program}}")
            complain("${place}" "only app/board.cpp and its parts may name a concrete driver, not ${header}")
        endif()
    elseif(NOT header MATCHES "^${folder}/" AND NOT header MATCHES "${rule}")
        complain("${place}" "${folder} may not include ${header}")
    endif()
    set(complaints "${complaints}" PARENT_SCOPE)
endfunction()

# Breadth first over includes_of_<file>; the first way found is the shortest.
function(check_reach start)
    set(open "${start}")
    set(seen "${start}")
    set(way_to_${start} "${start}")
    while(open)
        list(POP_FRONT open file)
        foreach(header IN LISTS includes_of_${file})
            if(header IN_LIST seen)
                continue()
            endif()
            list(APPEND seen "${header}")
            list(APPEND open "${header}")
            set(way_to_${header} "${way_to_${file}} -> ${header}")
            if(header MATCHES "${telemetry_headers}")
                complain("${start}" "telemetry is logged only, but is reached: ${way_to_${header}}")
            endif()
        endforeach()
    endwhile()
    set(complaints "${complaints}" PARENT_SCOPE)
endfunction()

execute_process(
    COMMAND grep -rnE --include=*.hpp --include=*.cpp --include=*.h --include=*.c
            "^[[:space:]]*#[[:space:]]*include[[:space:]]*[<\"]" ${folders}
    WORKING_DIRECTORY "${ROOT}" OUTPUT_VARIABLE found ERROR_QUIET)
string(REGEX MATCHALL "[^\n]+" lines "${found}")
if(NOT lines)
    message(FATAL_ERROR "no #include found below ${ROOT}: nothing was checked")
endif()

set(files "")
foreach(line IN LISTS lines)
    if(NOT line MATCHES "^(([a-z]+)/[^:]+):([0-9]+):[^<\"]*([<\"])([^>\"]+)[>\"]")
        message(FATAL_ERROR "cannot read: ${line}")
    endif()
    set(file "${CMAKE_MATCH_1}")
    set(folder "${CMAKE_MATCH_2}")
    set(place "${file}:${CMAKE_MATCH_3}")
    set(header "${CMAKE_MATCH_5}")
    if(CMAKE_MATCH_4 STREQUAL "<")
        check_other("${place}" "${folder}" "${header}")
    else()
        check_own("${place}" "${file}" "${folder}" "${header}")
        list(APPEND includes_of_${file} "${header}")
    endif()
    list(APPEND files "${file}")
endforeach()

list(REMOVE_DUPLICATES files)
list(FILTER files INCLUDE REGEX "${estimating_files}")
foreach(file IN LISTS files)
    check_reach("${file}")
endforeach()

if(complaints)
    message(FATAL_ERROR "Includes against the direction of the folders:${complaints}")
endif()
