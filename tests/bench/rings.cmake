find_package(nlohmann_json REQUIRED)
pkg_check_modules(ZeroMQ REQUIRED IMPORTED_TARGET libzmq)

add_executable(bench_rings rings.cpp rings_costs.cpp rings_measure.cpp rings_process.cpp rings_table.cpp rings_transports.cpp rings_zeromq.cpp)
target_link_libraries(bench_rings PRIVATE handcast_ring fmt::fmt PkgConfig::ZeroMQ)

add_executable(bench_rings_restarts rings_restarts.cpp rings_bare_rig.cpp rings_process.cpp rings_transports.cpp)
target_link_libraries(bench_rings_restarts PRIVATE handcast_supervisor handcast_ring fmt::fmt nlohmann_json::nlohmann_json)
add_dependencies(bench_rings_restarts handcast handcast_bare_daemon)
