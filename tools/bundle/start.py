"""Starts the program of a bundle, or the child process of the meshers in it."""

import sys

if sys.argv[1:] == ["mesher-worker"]:  # `WORKER_COMMAND` of akap_editor.meshing.mesher_process
    import mesher_worker  # without the package around it, which takes a second to load

    mesher_worker.main()
else:
    from akap_editor.cli import main

    main()
