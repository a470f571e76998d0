add_executable(bench_traces traces.cpp)
target_link_libraries(bench_traces PRIVATE handcast_supervisor handcast_runtime fmt::fmt)
