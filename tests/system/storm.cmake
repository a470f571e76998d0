# Processes killed at random, many times. HANDCAST_STORM_KILLS=10000 asks for more than the usual 500.
handcast_test(storm_tests
  SOURCES storm_crew.cpp storm_watch.cpp storm_rings_test.cpp
  LINKS handcast_ring
  LABELS system
  TIMEOUT 600)

add_executable(handcast_bare_daemon bare_daemon.cpp)
target_link_libraries(handcast_bare_daemon PRIVATE handcast_runtime)
