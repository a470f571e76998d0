add_executable(bench_landmarks landmarks.cpp landmarks_subjects.cpp)
target_link_libraries(bench_landmarks PRIVATE handcast_own_network fmt::fmt)
