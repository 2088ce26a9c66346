"""What SUMO's files may say here: its options, elements and device parameters, each taken, left out or refused.

SUMO writes wherever its configuration, its detectors and its vehicles tell it to. Of these tables only what is
taken reaches it, and what no table knows is refused; a test compares them with the installed SUMO.
"""

from __future__ import annotations

from collections.abc import Mapping


def _words(text: str) -> Mapping[str, str]:
    """Every name and synonym of ``name/synonym/...``, with the name that SUMO's documentation uses."""
    return {word: each.partition("/")[0] for each in text.split() for word in each.split("/")}


TAKEN = _words(
    """
    net-file/n/net route-files/r/routes additional-files/a/additional weight-files/w/weights
    weight-attribute/measure/x junction-taz
    begin/b end/e step-length
    step-method.ballistic extrapolate-departpos lateral-resolution route-steps/s ignore-junction-blocker
    ignore-route-errors ignore-accidents collision.action intermodal-collision.action collision.stoptime
    intermodal-collision.stoptime collision.check-junctions collision.check-junctions.mingap
    collision.mingap-factor keep-after-arrival max-num-vehicles max-num-persons max-num-teleports scale
    scale-suffix time-to-teleport time-to-teleport.highways time-to-teleport.highways.min-speed
    time-to-teleport.disconnected time-to-teleport.remove time-to-teleport.remove-constraint
    time-to-teleport.ride time-to-teleport.bidi time-to-teleport.railsignal-deadlock waiting-time-memory
    startup-wait-threshold max-depart-delay sloppy-insert eager-insert emergency-insert insertion-checks
    random-depart-offset lanechange.duration lanechange.overtake-right tls.all-off tls.actuated.show-detectors
    tls.actuated.jam-threshold tls.actuated.detector-length tls.delay_based.detector-range tls.yellow.min-decel
    railsignal-moving-block/railsignal.moving-block railsignal.moving-block.default-classes
    railsignal.moving-block.max-dist railsignal.max-block-length railsignal.default-classes slope-centered
    time-to-impatience default.departspeed default.departlane default.action-step-length
    default.carfollowmodel/carfollow.model default.speeddev default.emergencydecel overhead-wire.solver
    overhead-wire.recuperation overhead-wire.substation-current-limits emergencydecel.warning-threshold
    parking.maneuver use-stop-ended use-stop-started pedestrian.model pedestrian.timegap-crossing
    pedestrian.striping.stripe-width pedestrian.striping.dawdling pedestrian.striping.mingap-to-vehicle
    pedestrian.striping.jamtime pedestrian.striping.jamtime.crossing pedestrian.striping.jamtime.narrow
    pedestrian.striping.jamfactor pedestrian.striping.reserve-oncoming
    pedestrian.striping.reserve-oncoming.junctions pedestrian.striping.reserve-oncoming.max
    pedestrian.striping.legacy-departposlat pedestrian.striping.walkingarea-detail
    pedestrian.jupedsim.step-length pedestrian.jupedsim.exit-tolerance pedestrian.jupedsim.model
    pedestrian.jupedsim.strength-neighbor-repulsion pedestrian.jupedsim.range-neighbor-repulsion
    pedestrian.jupedsim.strength-geometry-repulsion pedestrian.jupedsim.range-geometry-repulsion
    ride.stop-tolerance mapmatch.distance mapmatch.junctions mapmatch.taz weights.turnaround-penalty
    weights.reversal-penalty persontrip.walk-opposite-factor
    routing-algorithm weights.random-factor weights.random-factor.dynamic weights.minor-penalty
    weights.tls-penalty weights.priority-factor weights.separate-turns persontrip.walkfactor
    persontrip.transfer.car-walk persontrip.transfer.taxi-walk persontrip.transfer.walk-taxi
    persontrip.default.group persontrip.taxi.waiting-time persontrip.ride-public-line railway.max-train-length
    replay-rerouting device.rerouting.probability device.rerouting.explicit/device.rerouting.knownveh
    device.rerouting.deterministic device.rerouting.period/device.routing.period
    device.rerouting.pre-period/device.routing.pre-period
    device.rerouting.adaptation-weight/device.routing.adaptation-weight
    device.rerouting.adaptation-steps/device.routing.adaptation-steps
    device.rerouting.adaptation-interval/device.routing.adaptation-interval
    device.rerouting.cch-update-threshold.factor device.rerouting.cch-update-threshold.constant
    device.rerouting.cch-ensemble device.rerouting.threshold.factor device.rerouting.threshold.constant
    device.rerouting.invalidation device.rerouting.with-taz/device.routing.with-taz/with-taz
    device.rerouting.mode device.rerouting.init-with-loaded-weights device.rerouting.synchronize
    device.rerouting.railsignal device.rerouting.bike-speeds person-device.rerouting.probability
    person-device.rerouting.explicit/person-device.rerouting.knownveh person-device.rerouting.deterministic
    person-device.rerouting.period/person-device.routing.period person-device.rerouting.mode
    person-device.rerouting.scope
    emissions.volumetric-fuel phemlight-year phemlight-temperature device.emissions.probability
    device.emissions.explicit/device.emissions.knownveh device.emissions.deterministic device.emissions.begin
    device.emissions.period
    device.btreceiver.probability device.btreceiver.explicit/device.btreceiver.knownveh
    device.btreceiver.deterministic device.btreceiver.range device.btreceiver.all-recognitions
    device.btreceiver.offtime device.btsender.probability device.btsender.explicit/device.btsender.knownveh
    device.btsender.deterministic person-device.btsender.probability
    person-device.btsender.explicit/person-device.btsender.knownveh person-device.btsender.deterministic
    person-device.btreceiver.probability person-device.btreceiver.explicit/person-device.btreceiver.knownveh
    person-device.btreceiver.deterministic
    device.stationfinder.probability device.stationfinder.explicit/device.stationfinder.knownveh
    device.stationfinder.deterministic device.stationfinder.rescueTime device.stationfinder.rescueAction
    device.stationfinder.reserveFactor device.stationfinder.emptyThreshold device.stationfinder.radius
    device.stationfinder.maxEuclideanDistance device.stationfinder.repeat device.stationfinder.chargeType
    device.stationfinder.waitForCharge device.stationfinder.minOpportunityDuration
    device.stationfinder.saturatedChargeLevel device.stationfinder.needToChargeLevel
    device.stationfinder.opportunisticChargeLevel device.stationfinder.replacePlannedStop
    device.stationfinder.maxDistanceToReplacedStop device.stationfinder.chargingStrategy
    device.stationfinder.checkEnergyForRoute device.battery.probability
    device.battery.explicit/device.battery.knownveh device.battery.deterministic device.battery.track-fuel
    device.example.probability device.example.explicit/device.example.knownveh device.example.deterministic
    device.example.parameter
    device.toc.probability device.toc.explicit/device.toc.knownveh device.toc.deterministic
    device.toc.manualType device.toc.automatedType device.toc.responseTime device.toc.recoveryRate
    device.toc.lcAbstinence device.toc.initialAwareness device.toc.mrmDecel device.toc.dynamicToCThreshold
    device.toc.dynamicMRMProbability device.toc.mrmKeepRight device.toc.mrmSafeSpot
    device.toc.mrmSafeSpotDuration device.toc.maxPreparationAccel device.toc.ogNewTimeHeadway
    device.toc.ogNewSpaceHeadway device.toc.ogMaxDecel device.toc.ogChangeRate device.toc.useColorScheme
    device.driverstate.probability device.driverstate.explicit/device.driverstate.knownveh
    device.driverstate.deterministic device.driverstate.initialAwareness
    device.driverstate.errorTimeScaleCoefficient device.driverstate.errorNoiseIntensityCoefficient
    device.driverstate.speedDifferenceErrorCoefficient device.driverstate.headwayErrorCoefficient
    device.driverstate.freeSpeedErrorCoefficient device.driverstate.speedDifferenceChangePerceptionThreshold
    device.driverstate.headwayChangePerceptionThreshold device.driverstate.minAwareness
    device.driverstate.maximalReactionTime
    device.bluelight.probability device.bluelight.explicit/device.bluelight.knownveh
    device.bluelight.deterministic device.bluelight.reactiondist device.bluelight.mingapfactor
    device.fcd.probability device.fcd.explicit/device.fcd.knownveh device.fcd.deterministic device.fcd.begin
    device.fcd.period device.fcd.radius person-device.fcd.probability
    person-device.fcd.explicit/person-device.fcd.knownveh person-device.fcd.deterministic
    person-device.fcd.period
    device.elechybrid.probability device.elechybrid.explicit/device.elechybrid.knownveh
    device.elechybrid.deterministic
    device.taxi.probability device.taxi.explicit/device.taxi.knownveh device.taxi.deterministic
    device.taxi.dispatch-algorithm device.taxi.dispatch-algorithm.params device.taxi.dispatch-period
    device.taxi.dispatch-keep-unreachable device.taxi.idle-algorithm device.taxi.vclasses/taxi.vclasses
    device.glosa.probability device.glosa.explicit/device.glosa.knownveh device.glosa.deterministic
    device.glosa.range device.glosa.max-speedfactor device.glosa.min-speed device.glosa.add-switchtime
    device.glosa.use-queue device.glosa.override-safety device.glosa.ignore-cfmodel
    device.tripinfo.probability device.tripinfo.explicit/device.tripinfo.knownveh device.tripinfo.deterministic
    device.vehroute.probability device.vehroute.explicit/device.vehroute.knownveh device.vehroute.deterministic
    device.friction.probability device.friction.explicit/device.friction.knownveh device.friction.deterministic
    device.friction.stdDev device.friction.offset
    device.fcd-replay.probability device.fcd-replay.explicit/device.fcd-replay.knownveh
    device.fcd-replay.deterministic device.fcd-replay.consistency
    meso-ltm meso-edgelength meso-tauff meso-taufj meso-taujf meso-taujj meso-jam-threshold
    meso-multi-queue meso-lane-queue meso-ignore-lanes-by-vclass/meso.ignore-lanes.by-vclass
    meso-junction-control meso-junction-control.limited meso-tls-penalty meso-tls-flow-penalty
    meso-minor-penalty meso-overtaking meso-recheck meso-interpolate-pos
    seed/srand thread-rngs
    """
)
"""Options that a configuration may set."""

IGNORED = _words(
    """
    configuration-file/c/configuration save-configuration/C/save-config
    save-configuration.relative/save-config.relative save-template save-schema
    save-commented/save-template.commented
    write-license write-metadata output-prefix output-suffix precision precision.geo output.compression
    output.format output.column-header output.column-separator human-readable-time/H
    netstate-dump/ndump/netstate/netstate-output
    netstate-dump.empty-edges/dump-empty-edges/netstate-output.empty-edges/netstate.empty-edges
    netstate-dump.precision/dump-precision/netstate-output.precision/netstate.precision emission-output
    emission-output.precision emission-output.geo emission-output.step-scaled emission-output.attributes
    battery-output battery-output.precision elechybrid-output elechybrid-output.precision
    elechybrid-output.aggregated chargingstations-output chargingstations-output.aggregated
    chargingstations-output.aggregated.write-unfinished overheadwiresegments-output substations-output
    substations-output.precision fcd-output fcd-output.geo fcd-output.utm fcd-output.signals fcd-output.distance
    fcd-output.acceleration fcd-output.speed-relative fcd-output.max-leader-distance fcd-output.params
    fcd-output.filter-edges.input-file fcd-output.attributes fcd-output.filter-shapes fcd-output.skip-empty
    person-fcd-output/person-fcd device.ssm.filter-edges.input-file full-output queue-output queue-output.period
    queue-output.aggregation queue-output.speed-threshold queue-output.percentile queue-output.skip-empty
    vtk-output amitran-output summary-output/summary summary-output.period person-summary-output
    tripinfo-output/tripinfo tripinfo-output.write-unfinished tripinfo-output.write-undeparted
    personinfo-output/personinfo vehroute-output/vehroutes vehroute-output.exit-times/vehroutes.exit-times
    vehroute-output.last-route/vehroutes.last-route vehroute-output.sorted/vehroutes.sorted
    vehroute-output.dua/vehroutes.dua vehroute-output.cost
    vehroute-output.intended-depart/vehroutes.intended-depart
    vehroute-output.route-length/vehroutes.route-length vehroute-output.write-unfinished
    vehroute-output.skip-ptlines vehroute-output.incomplete vehroute-output.stop-edges
    vehroute-output.speedfactor vehroute-output.internal personroute-output/personroutes link-output
    railsignal-block-output railsignal-vehicle-output bt-output lanechange-output lanechange-output.started
    lanechange-output.ended lanechange-output.xy stop-output stop-output.write-unfinished collision-output
    edgedata-output lanedata-output statistic-output/statistics-output deadlock-output save-state.times
    save-state.period save-state.period.keep save-state.prefix save-state.suffix save-state.files save-state.rng
    save-state.transportables save-state.constraints save-state.precision pedestrian.jupedsim.wkt
    pedestrian.jupedsim.wkt.geo pedestrian.jupedsim.py
    no-internal-links device.rerouting.output
    verbose/v print-options help/? version/V xml-validation/X xml-validation.net xml-validation.routes
    no-warnings/W/suppress-warnings aggregate-warnings log/l/log-file message-log error-log log.timestamps
    log.processid language duration-log.disable/no-duration-log duration-log.statistics/t no-step-log
    step-log.period
    device.ssm.probability device.ssm.explicit/device.ssm.knownveh device.ssm.deterministic device.ssm.measures
    device.ssm.thresholds device.ssm.trajectories device.ssm.range device.ssm.extratime device.ssm.mdrac.prt
    device.ssm.file device.ssm.geo device.ssm.write-positions device.ssm.write-lane-positions
    device.ssm.write-na device.ssm.exclude-conflict-types
    device.toc.file
    device.taxi.dispatch-algorithm.output device.taxi.idle-algorithm.output
    remote-port num-clients
    random/abs-rand
    gui-settings-file/g quit-on-end/Q game/G game.mode start/S delay/d breakpoints/B edgedata-files/data-files/m
    alternative-net-file/N selection-file demo/D disable-textures/T registry-viewport window-size window-pos
    tracker-interval gui-testing gui-testing-debug gui-testing.setting-output
    """
)
"""Options without effect here: outputs, reports, the window, and what a run sets itself. SUMO does not read a
configuration inside a configuration either."""

PARALLEL = _words("threads device.rerouting.threads/routing-threads")
"""Options that make SUMO work in parallel. A copy by fork has the thread that forks and no other, and waits for the
rest for ever (seen in SUMO 1.28), so they are set aside."""

WINDOW = _words("osg-view")
"""Options without effect here that SUMO knows only where its window is built with them."""

MESOSCOPIC = "mesosim"
"""The option of the mesoscopic model, whose vehicles are in no lane: nobody can drive among them."""

REFUSED = _words(
    """
    load-state load-state.offset load-state.remove-vehicles
    astar.all-distances astar.landmark-distances
    phemlight-path
    device.fcd-replay.files/device.fcd-replay.file
    """
)
"""Options that name files of other forms, which are not checked."""

DEVICE_PARAMETERS = frozenset(
    _words(
        """
        device.battery.actualBatteryCapacity device.battery.capacity device.battery.chargeCurveTable
        device.battery.chargeLevel device.battery.chargeLevelTable device.battery.maximumBatteryCapacity
        device.battery.maximumChargeRate device.battery.stoppingThreshold device.bluelight.near-dist
        device.bluelight.reaction-prob-far device.bluelight.reaction-prob-near device.example.customParameter1
        device.taxi.dropOffDuration device.taxi.end device.taxi.parking device.taxi.pickUpDuration
        device.taxi.stands-rerouter device.taxi.state device.taxi.swapGroup device.toc.requestToC
        """
    )
)
"""Parameters of vehicles and their types, besides the options."""

DEVICES = frozenset(name.split(".")[1] for name in (*TAKEN, *IGNORED) if name.endswith(".probability"))
"""The ``*`` of ``has.*.device``."""

ELEMENTS = frozenset(
    _words(
        """
        WAUT access additional assignment bidiPredecessor busStop calibrator carFollowing-ACC
        carFollowing-BKerner carFollowing-CACC carFollowing-CC carFollowing-Daniel1 carFollowing-EIDM
        carFollowing-IDM carFollowing-IDMM carFollowing-Krauss carFollowing-KraussOrig1 carFollowing-KraussPS
        carFollowing-PWagner2009 carFollowing-SmartSK carFollowing-W99 carFollowing-Wiedemann chargingStation
        closingLaneReroute closingReroute condition conflict connection container containerFlow containerStop
        deadlock delete destProbReroute detEntry detExit e1Detector e2Detector e3Detector edge edgeData
        entryExitDetector flow foeInsertion function include inductionLoop insertionOrder insertionPredecessor
        instantInductionLoop interval junction lane laneAreaDetector laneData laneType location meandata meso
        metadata neigh net overheadWire overheadWireClamp overheadWireSegment overtakingReroute param
        parkingArea parkingAreaReroute person personFlow personTrip phase poi poly predecessor preference
        prohibition railSignalConstraints request rerouter rerouterValue restriction ride roundabout route
        route-alternatives routeDistribution routeProbReroute routeProbe routes space stationReroute step stop
        stopOffset taz tazSink tazSource tazs timedEvent tlLogic tlLogics tractionSubstation trainStop tranship
        transport trip type types vType vTypeDistribution vTypeProbe vaporizer variableSpeedSign vehicle
        viaProbReroute walk wautJunction wautSwitch
        """
    )
)
"""Elements of networks, routes and additional files."""

OUTPUTS: Mapping[str, str] = {
    **dict.fromkeys(
        _words(
            "e1Detector inductionLoop e2Detector laneAreaDetector e3Detector entryExitDetector "
            "instantInductionLoop edgeData laneData routeProbe vTypeProbe"
        ),
        "file",
    ),
    "calibrator": "output",
    "timedEvent": "dest",
}
"""Elements that write, with the attribute that says where."""

INPUTS: Mapping[str, str] = {
    "include": "href",
    **dict.fromkeys(("variableSpeedSign", "rerouter", "calibrator"), "file"),
    **dict.fromkeys(("edgeData", "laneData"), "edgesFile"),
}
"""Elements that read a file, with the attribute that names it."""

WRITING_LIGHT = "file"
"""The parameter with which a traffic light's detectors write."""

LOGGING_LIGHT = "SWARMLOG"
"""The parameter with which a traffic light of type ``swarm`` opens a log; ``NUL`` would be a file of that name."""


def parameter(key: str) -> bool | None:
    """Whether a parameter is taken; None if it is left out, since SUMO would write.

    Raises:
        KeyError: it is a device's, and unknown.
    """
    if key == LOGGING_LIGHT:
        return None
    if not key.startswith(("device.", "person-device.", "has.")):
        return True
    if key.startswith("has."):
        device = key.removeprefix("has.").removesuffix(".device")
        if device not in DEVICES or not key.endswith(".device"):
            raise KeyError(key)
        return None if device == "ssm" else True
    if key in TAKEN or key in DEVICE_PARAMETERS:
        return True
    if key in IGNORED or key in PARALLEL:
        return None
    raise KeyError(key)
