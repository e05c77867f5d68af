find_path(APRILTAG_INCLUDE_DIR apriltag/apriltag.h REQUIRED)
find_library(APRILTAG_LIBRARY apriltag REQUIRED)
add_library(apriltag::apriltag UNKNOWN IMPORTED)
set_target_properties(apriltag::apriltag PROPERTIES
    IMPORTED_LOCATION ${APRILTAG_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${APRILTAG_INCLUDE_DIR})
