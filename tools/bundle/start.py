"""Starts the program of a bundle, or one of its child processes."""

import sys

if sys.argv[1:] == ["mesher-worker"]:  # `WORKER_COMMAND` of akap_editor.meshing.mesher_process
    import mesher_worker  # without the package around it, which takes a second to load

    mesher_worker.main()
elif sys.argv[1:2] == ["compile-engine"]:  # `COMMAND` of akap_editor.app.jobs.engine_preparation
    from akap_editor.app.jobs.engine_preparation import compile_part

    compile_part(sys.argv[2])
else:
    from akap_editor.cli import main

    main()
