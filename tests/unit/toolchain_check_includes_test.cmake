# The include check catches what it is there for: each case is a small tree with one planted line.
#   cmake -D SCRIPT=toolchain/check_includes.cmake -D WORK=<empty folder> -P <this file>
cmake_minimum_required(VERSION 3.22)

function(check tree result)
    execute_process(COMMAND ${CMAKE_COMMAND} -D ROOT=${tree} -P ${SCRIPT}
        RESULT_VARIABLE code ERROR_VARIABLE text)
    string(REGEX REPLACE "[ \n]+" " " text "${text}")
    set(${result} "${code}: ${text}" PARENT_SCOPE)
endfunction()

# A tree that keeps every rule, with each permission in use.
function(make_tree tree)
    file(REMOVE_RECURSE ${tree})
    file(WRITE ${tree}/hal/hitch_angle.hpp "#include <cstdint>\n")
    file(WRITE ${tree}/hal/frame.hpp "#include <array>\n")
    file(WRITE ${tree}/hal/publisher.hpp "#include \"hal/hitch_angle.hpp\"\n")
    file(WRITE ${tree}/algo/camera_model.hpp "#include <Eigen/Core>\n")
    file(WRITE ${tree}/calib/rig.hpp "#include \"algo/camera_model.hpp\"\n#include <yaml-cpp/yaml.h>\n")
    file(WRITE ${tree}/drivers/lcm_url.hpp "#include <lcm/lcm.h>\n")
    file(WRITE ${tree}/drivers/lcm_publisher.cpp
        "#include \"drivers/lcm_url.hpp\"\n#include \"hal/publisher.hpp\"\n#include \"lcmtypes/a_t.h\"\n")
    file(WRITE ${tree}/drivers/simulated_rig.cpp "#include \"algo/camera_model.hpp\"\n")
    file(WRITE ${tree}/app/config.hpp "#include \"calib/rig.hpp\"\n")
    file(WRITE ${tree}/app/pipeline.hpp "#include \"app/config.hpp\"\n#include \"hal/frame.hpp\"\n")
    file(WRITE ${tree}/app/board.cpp "#include \"drivers/lcm_url.hpp\"\n#include \"app/config.hpp\"\n")
    file(WRITE ${tree}/app/view_verb.cpp "#include \"drivers/lcm_subscriber.hpp\"\n")
    file(WRITE ${tree}/app/truth_sight.cpp "#include \"drivers/simulated_rig.hpp\"\n#include \"algo/camera_model.hpp\"\n")
    file(WRITE ${tree}/app/evaluation.cpp "#include \"drivers/replay_camera.hpp\"\n")
    file(WRITE ${tree}/app/frame_set.hpp "#include \"hal/frame.hpp\"\n")
    file(WRITE ${tree}/app/rig_geometry.cpp "#include \"app/config.hpp\"\n")
endfunction()

function(expect_caught file line complaint)
    make_tree(${WORK}/tree)
    file(APPEND ${WORK}/tree/${file} "#include ${line}\n")
    check(${WORK}/tree got)
    string(FIND "${got}" "${complaint}" at)
    if(at EQUAL -1)
        message(SEND_ERROR "${file} with ${line}: expected '${complaint}', got '${got}'")
    endif()
endfunction()

make_tree(${WORK}/tree)
check(${WORK}/tree clean)
if(NOT clean STREQUAL "0: ")
    message(SEND_ERROR "a tree that keeps the rules is refused: ${clean}")
endif()

expect_caught(hal/frame.hpp [["algo/camera_model.hpp"]]
    "hal/frame.hpp:2: hal may not include algo/camera_model.hpp")
expect_caught(hal/frame.hpp [[<opencv2/core.hpp>]] "hal/frame.hpp:2: hal may not include <opencv2/core.hpp>")
expect_caught(algo/camera_model.hpp [["hal/frame.hpp"]]
    "algo/camera_model.hpp:2: algo may not include hal/frame.hpp")
expect_caught(algo/camera_model.hpp [[<yaml-cpp/yaml.h>]] "algo may not include <yaml-cpp/yaml.h>")
expect_caught(calib/rig.hpp [["hal/frame.hpp"]] "calib/rig.hpp:3: calib may not include hal/frame.hpp")
expect_caught(calib/rig.hpp [["app/config.hpp"]] "calib may not include app/config.hpp")
expect_caught(drivers/simulated_rig.cpp [["algo/mesh.hpp"]] "drivers may not include algo/mesh.hpp")
expect_caught(drivers/lcm_publisher.cpp [["algo/camera_model.hpp"]]
    "drivers/lcm_publisher.cpp:4: drivers may not include algo/camera_model.hpp")
expect_caught(drivers/simulated_rig.cpp [["drivers/lcm_url.hpp"]]
    "driver simulated may not include another driver, drivers/lcm_url.hpp")
expect_caught(app/config.hpp [["drivers/lcm_url.hpp"]]
    "app/config.hpp:2: only app/board.cpp and its parts may name a concrete driver, not drivers/lcm_url.hpp")
expect_caught(app/view_verb.cpp [["drivers/lcm_url.hpp"]] "only app/board.cpp and its parts may name a concrete driver")
expect_caught(app/truth_sight.cpp [["drivers/lcm_publisher.hpp"]] "only app/board.cpp and its parts may name a concrete driver")
expect_caught(app/evaluation.cpp [["drivers/simulated_rig.hpp"]] "only app/board.cpp and its parts may name a concrete driver")
expect_caught(app/frame_set.hpp [["hal/hitch_angle.hpp"]] "reached: app/frame_set.hpp -> hal/hitch_angle.hpp")
expect_caught(app/rig_geometry.cpp [["hal/publisher.hpp"]] "reached: app/rig_geometry.cpp -> hal/publisher.hpp")
expect_caught(app/pipeline.hpp [["hal/publisher.hpp"]]
    "reached: app/pipeline.hpp -> hal/publisher.hpp -> hal/hitch_angle.hpp")

expect_caught(app/pipeline.hpp [["app/dbc_file.hpp"]] "reached: app/pipeline.hpp -> app/dbc_file.hpp")
expect_caught(app/config.hpp [["app/can_field.hpp"]] "reached: app/pipeline.hpp -> app/config.hpp -> app/can_field.hpp")
expect_caught(algo/camera_model.hpp [["drivers/socketcan_bus.hpp"]]
    "reached: algo/camera_model.hpp -> drivers/socketcan_bus.hpp")

file(REMOVE_RECURSE ${WORK}/tree ${WORK}/empty)
file(MAKE_DIRECTORY ${WORK}/empty)
check(${WORK}/empty nothing)
if(NOT nothing MATCHES "nothing was checked")
    message(SEND_ERROR "a tree without sources passes: ${nothing}")
endif()
file(REMOVE_RECURSE ${WORK}/empty)
