handcast_test(system_traces_tests
  SOURCES command.cpp running_rig.cpp traces_test.cpp ../supervisor/trace/trace_decoder.cpp
  LINKS handcast_twin nlohmann_json::nlohmann_json
  LABELS system
  TIMEOUT 300)
foreach(program handcast handcast-camera handcast-pose handcast-landmarks handcast-projector handcast-observer handcast_hands)
  if(TARGET ${program})
    add_dependencies(system_traces_tests ${program})
  endif()
endforeach()
