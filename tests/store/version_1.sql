PRAGMA foreign_keys=OFF;
BEGIN TRANSACTION;
CREATE TABLE study (
    id                 INTEGER PRIMARY KEY,      -- from the name
    name               TEXT    NOT NULL UNIQUE,
    question           TEXT,                     -- what the study asks, in the author's words
    design             TEXT    NOT NULL CHECK (design IN ('paired_seeds', 'independent')),
    seed               INTEGER NOT NULL,         -- all randomness of the study follows from it
    replications       INTEGER NOT NULL,         -- planned per scenario and variant
    duration_s         REAL    NOT NULL,         -- simulated time of a replication, warm-up included
    warmup_s           REAL    NOT NULL,         -- crashes and exposure before it are not counted
    step_length_s      REAL    NOT NULL,         -- of the traffic simulation
    vehicles           TEXT    NOT NULL CHECK (json_valid(vehicles)),
    -- {"default": vehicle model, "types": {SUMO vehicle type: vehicle model}}
    yaml               TEXT    NOT NULL,         -- the study file, word for word
    hash               TEXT    NOT NULL          -- SHA-256 of the study file
) STRICT;
INSERT INTO study VALUES(3989277409660,'version_1',NULL,'paired_seeds',5,2,25.0,0.0,0.050000000000000002775,'{"default":"car","types":{"van":"van"}}',replace('study: version_1\n','\n',char(10)),'ba786fed2330909693d5a37a6f27ee603984dcfdcd971d983526956b1a42d7e3');
CREATE TABLE scenario (
    id                 INTEGER PRIMARY KEY,      -- from the name
    name               TEXT    NOT NULL UNIQUE,
    number             INTEGER NOT NULL,         -- place in the study file, from 0
    sumocfg            TEXT    NOT NULL,         -- as written in the study file
    sumo_options       TEXT    NOT NULL CHECK (json_valid(sumo_options)), -- array of words
    files              TEXT    NOT NULL CHECK (json_valid(files)),
    -- {file: SHA-256} of the sumocfg and of the networks, routes and additional files it names, XML
    -- comments left out (netconvert writes the date into one)
    driver_errors      TEXT    NOT NULL CHECK (json_valid(driver_errors))
    -- array of {"model": …, "parameters": {name: value}}, defaults filled in: the assumption every
    -- rate depends on
) STRICT;
INSERT INTO scenario VALUES(3729556851407,'crossing',0,'crossing.sumocfg','[]','{"crossing.net.xml":"021865d2807414d36bbf5d48e24c79015482dce3549d05fbfc0cefc1ad09f1c4","crossing.rou.xml":"20668c6f86d362cee2780630f5bb0e0f1292a2ac85dd225368ea35b53d45e1a2","crossing.sumocfg":"0d3dccfff4df198564971b80cd5534d4abf761acf3b4fa8f9a7e0d1c75047576"}','[{"model":"failed_to_see","parameters":{"probability_1":1.0}}]');
CREATE TABLE variant (
    id                 INTEGER PRIMARY KEY,      -- from the name
    name               TEXT    NOT NULL UNIQUE,
    number             INTEGER NOT NULL,         -- place in the study file, from 0
    is_baseline        INTEGER NOT NULL CHECK (is_baseline IN (0, 1)),
    functions          TEXT    NOT NULL CHECK (json_valid(functions))
    -- array of {"function": …, "parameters": {name: value}}, defaults filled in
) STRICT;
INSERT INTO variant VALUES(955645882439,'aeb',1,0,'[{"function":"aeb","parameters":{"penetration_1":1.0,"ttc_s":1.2,"deceleration_m_s2":8.0,"dead_time_s":0.1,"jerk_m_s3":40.0,"friction_1":0.9,"speed_min_m_s":2.78,"speed_max_m_s":60.0,"sensor_range_m":80.0,"sensor_field_of_view_deg":60.0,"sensor_latency_s":0.1,"release_ttc_s":3.0,"hold_s":0.5}}]');
INSERT INTO variant VALUES(2399295350932,'baseline',0,1,'[]');
CREATE TABLE replication (
    id                 INTEGER PRIMARY KEY,      -- from "scenario|variant|sweep|seed"
    scenario_id        INTEGER NOT NULL REFERENCES scenario (id),
    variant_id         INTEGER NOT NULL REFERENCES variant (id),
    sweep              TEXT    NOT NULL DEFAULT '', -- sweep point; empty without a sweep
    number             INTEGER NOT NULL,         -- from 0; paired seeds: the same number shares the seed
    seed               INTEGER NOT NULL,         -- of SUMO and of our own draws
    status             TEXT    NOT NULL DEFAULT 'planned'
                       CHECK (status IN ('planned', 'running', 'done', 'failed')),
    configuration_hash TEXT    NOT NULL,         -- SHA-256 of everything the outcome depends on
    -- from here on NULL until the status is done
    crashpulse_version TEXT,
    sumo_version       TEXT,
    sumo_command_line  TEXT,                     -- all SUMO options of the run, ours included
    simulated_s        REAL,                     -- counted time: without warm-up
    vehicle_km         REAL,                     -- driven by all vehicles in that time
    vehicle_h          REAL,                     -- spent on the road by all vehicles in that time
    departed           INTEGER,                  -- vehicles inserted in that time
    counters           TEXT    CHECK (counters IS NULL OR json_valid(counters)),
    -- what drivers and functions did: {"aeb.activations": 12, …}
    UNIQUE (scenario_id, variant_id, sweep, seed)
) STRICT;
INSERT INTO replication VALUES(366549230976,3729556851407,955645882439,'',0,421632325,'done','2af8c1010f3f68b65f18ebcb9c83b71d83ff3fa03f42b4a89aaba2bc8f7757ea','0.1.0','SUMO 1.15.0','sumo -c crossing.sumocfg',25.0,2.4556495589227753661,0.051916666666669109009,15,'{"aeb.activations":3.0,"aeb.braking_s":4.09999999999999,"aeb.equipped_vehicles":15.0,"failed_to_see.overlooked_pairs":196.0,"failed_to_see.pairs":196.0}');
INSERT INTO replication VALUES(841268759322,3729556851407,2399295350932,'',1,928584438,'done','900f2be2a8634085fd0cd8541d896d4dbd5f73aa32755e048698255b85d6eafd','0.1.0','SUMO 1.15.0','sumo -c crossing.sumocfg',25.0,2.1535471509422543512,0.045138888888890948969,15,'{"failed_to_see.overlooked_pairs":168.0,"failed_to_see.pairs":168.0}');
INSERT INTO replication VALUES(1710016921748,3729556851407,2399295350932,'',0,421632325,'done','c6418dd2a8b067da01671c379cdbe6fb2c2371e2f333188ff9b7cab53bfe32b7','0.1.0','SUMO 1.15.0','sumo -c crossing.sumocfg',25.0,2.4654745049424917624,0.050777777777780155887,15,'{"failed_to_see.overlooked_pairs":196.0,"failed_to_see.pairs":196.0}');
INSERT INTO replication VALUES(2742170402201,3729556851407,955645882439,'',1,928584438,'done','b856c9acb130537225dbf170ce4fe5acca30b6b0d1ab6735f329ee3ccb44881a','0.1.0','SUMO 1.15.0','sumo -c crossing.sumocfg',25.0,2.2193705218353216856,0.05066666666666903851,15,'{"aeb.activations":6.0,"aeb.braking_s":8.74999999999999,"aeb.equipped_vehicles":15.0,"failed_to_see.overlooked_pairs":196.0,"failed_to_see.pairs":196.0}');
CREATE TABLE attempt (
    replication_id     INTEGER NOT NULL REFERENCES replication (id),
    number             INTEGER NOT NULL,         -- from 1
    host               TEXT    NOT NULL,
    pid                INTEGER NOT NULL,
    process_start      INTEGER NOT NULL,         -- start of that process, clock ticks since boot:
                                                 -- tells it from a later process with the same pid
    started            TEXT    NOT NULL,         -- UTC, ISO 8601
    wall_time_s        REAL,                     -- NULL while running
    outcome            TEXT    NOT NULL
                       CHECK (outcome IN ('running', 'done', 'failed', 'lost', 'interrupted')),
    message            TEXT,                     -- why it failed: SUMO's last words
    PRIMARY KEY (replication_id, number)
) STRICT, WITHOUT ROWID;
INSERT INTO attempt VALUES(366549230976,1,'here',30908,58334,'2026-01-01T00:00:00.000Z',0.10000000000000000555,'done',NULL);
INSERT INTO attempt VALUES(841268759322,1,'here',30909,58347,'2026-01-01T00:00:00.000Z',0.10000000000000000555,'done',NULL);
INSERT INTO attempt VALUES(1710016921748,1,'here',30907,58334,'2026-01-01T00:00:00.000Z',0.10000000000000000555,'done',NULL);
INSERT INTO attempt VALUES(2742170402201,1,'here',30910,58348,'2026-01-01T00:00:00.000Z',0.10000000000000000555,'done',NULL);
CREATE TABLE vehicle_model (
    name               TEXT    PRIMARY KEY,
    hash               TEXT    NOT NULL,         -- SHA-256 of the vehicle file
    yaml               TEXT    NOT NULL          -- the vehicle file, word for word
) STRICT, WITHOUT ROWID;
INSERT INTO vehicle_model VALUES('car','d29abd6847bc578a817e13c1f790e351706d38b553e784c77670dc8cfc493f6b',replace('vehicle: car\nparameters:\n  - {name: mass_kg, value: 1500}\n','\n',char(10)));
INSERT INTO vehicle_model VALUES('van','b318bd70a3b4706501dced9a3c1e8eb11de62f4512850191990da75b5ee48077',replace('vehicle: van\nparameters:\n  - {name: mass_kg, value: 2100}\n','\n',char(10)));
CREATE TABLE crash (
    id                 INTEGER PRIMARY KEY,      -- replication_id * 2^20 + number
    replication_id     INTEGER NOT NULL REFERENCES replication (id),
    number             INTEGER NOT NULL,         -- from 0, in order of time_s, then SUMO ids
    time_s             REAL    NOT NULL,         -- SUMO clock, inside a step
    x_m                REAL    NOT NULL,         -- first contact point, world
    y_m                REAL    NOT NULL,
    crash_type         TEXT    NOT NULL CHECK (crash_type IN ('front-front', 'front-side',
                           'front-rear', 'side-side', 'side-rear', 'rear-rear')),
    closing_speed_m_s  REAL    NOT NULL,         -- relative speed of the bodies at the contact point
    lateral_offset_m   REAL    NOT NULL,         -- middle of b's front edge in a's frame, y
    angle_rad          REAL    NOT NULL,         -- wrap(yaw_b - yaw_a - pi): 0 exactly oncoming
    overlap_1          REAL,                     -- share of a's width covered by b; NULL unless a's
                                                 -- front is struck
    validity           TEXT    NOT NULL,         -- 'inside' when it is for both vehicles, else the
                                                 -- list of what is outside for either
    t_common_s         REAL,                     -- relative velocity first zero along its initial
                                                 -- direction, from first contact
    separation_s       REAL,                     -- last contact force, from first contact
    shift_m            REAL,                     -- the model outlines were moved this far along the
                                                 -- relative velocity until they just touched
    UNIQUE (replication_id, number),
    CHECK (id = replication_id * 1048576 + number AND number BETWEEN 0 AND 1048575)
) STRICT;
INSERT INTO crash VALUES(384354726419890176,366549230976,0,24.451208316242130536,150.7882193852617263,148.76184445991958681,'front-front',4.4488341785651135396,-0.69586685701635431211,-0.5725762720699396624,0.53029514620329332164,'oblique_velocity,model',0.065393636191540552293,0.12900000000000000355,0.17902951593773031024);
INSERT INTO crash VALUES(882134230574825472,841268759322,0,17.248962257848166502,154.63136932632752973,149.30000000000001136,'front-side',20.079729744583662664,2.0621098683031426901,-0.23590287269284093696,0.432353869723595019,'contact_side,opponent_structure,model',NULL,0.088499999999999995337,0.77635582426171512171);
INSERT INTO crash VALUES(882134230574825473,841268759322,1,20.094037960392277853,150.85210443066796415,148.81171898058425995,'front-front',22.169338551478595888,-0.65247358875635119712,-0.5659371840692770661,0.55360210650931973574,'oblique_velocity,model',0.079114690808866183768,0.10899999999999999966,0.15971002703642583897);
INSERT INTO crash VALUES(1793082703738830848,1710016921748,0,22.441420639205968967,150.10584720685474735,147.5,'front-side',20.069939435742647048,-1.6673940160735014615,0.76379600704756178686,1.0,'oblique_velocity,contact_side,opponent_structure,model',NULL,0.14749999999999999222,0.4827361359330989976);
INSERT INTO crash VALUES(2875374071658315776,2742170402201,0,22.265475375734737895,150.44269117196003549,147.5,'front-side',5.0885340377043766224,-2.5031110266416192189,0.84486354845068056818,1.0,'oblique_velocity,contact_side,opponent_structure,model',NULL,0.13400000000000000799,0.86644155410031487019);
CREATE TABLE crash_vehicle (
    crash_id           INTEGER NOT NULL REFERENCES crash (id),
    role               TEXT    NOT NULL CHECK (role IN ('a', 'b')),
    scenario_id        INTEGER NOT NULL,         -- copies of the crash's, so that distributions
    variant_id         INTEGER NOT NULL,         -- need no join; kept true by a trigger
    crash_type         TEXT    NOT NULL,
    frontal            INTEGER NOT NULL CHECK (frontal = (contact_side = 'front')),
                                                 -- 1: struck on its front, the unit of OLC
                                                 -- distributions
    sumo_id            TEXT    NOT NULL,
    sumo_type          TEXT    NOT NULL,
    vehicle_model      TEXT    NOT NULL REFERENCES vehicle_model (name),
    at_fault           INTEGER NOT NULL CHECK (at_fault IN (0, 1)), -- a driver error was active on it
    cog_x_m            REAL    NOT NULL,         -- centre of gravity at first contact, world
    cog_y_m            REAL    NOT NULL,
    yaw_rad            REAL    NOT NULL,
    velocity_x_m_s     REAL    NOT NULL,         -- of the centre of gravity, world
    velocity_y_m_s     REAL    NOT NULL,
    yaw_rate_rad_s     REAL    NOT NULL,
    speed_m_s          REAL    NOT NULL,         -- forward speed
    length_m           REAL    NOT NULL,         -- of its SUMO rectangle
    width_m            REAL    NOT NULL,
    velocity_angle_rad REAL,                     -- relative velocity against its own x axis,
                                                 -- 0 straight ahead
    contact_side       TEXT    NOT NULL CHECK (contact_side IN ('front', 'left', 'right', 'rear')),
    validity           TEXT    NOT NULL,         -- 'inside', or what is outside the calibrated range:
                                                 -- 'speed,angle'
    olc_g              REAL,                     -- occupant load criterion; NULL unless olc_status is
                                                 -- 'value'
    olc_status         TEXT    NOT NULL CHECK (olc_status IN ('value', 'not_front_contact',
                           'no_deceleration', 'beyond_0_5_s', 'simulation_failed')),
                                                 -- no_deceleration and beyond_0_5_s are left-censored:
                                                 -- they count below every value
    olc_t1_s           REAL,                     -- free flight of 65 mm ends
    olc_t2_s           REAL,                     -- 300 mm used up
    delta_v_m_s        REAL,                     -- magnitude of the change of velocity
    delta_v_x_m_s      REAL,                     -- v_x at first contact minus at the end
    delta_v_y_m_s      REAL,
    peak_g             REAL,                     -- largest deceleration along x, CFC60
    mean_g             REAL,                     -- mean deceleration until the lowest v_x
    t_v0_s             REAL,                     -- first v_x <= 0; against a barrier only, else NULL
    max_50ms_g         REAL,                     -- largest 50 ms moving mean deceleration along x
    asi_1              REAL,                     -- acceleration severity index
    pdof_rad           REAL,                     -- principal direction of force, vehicle axes
    yaw_change_rad_s   REAL,                     -- yaw rate at the end minus at first contact
    crush_m            REAL,                     -- largest dynamic shortening of the front
    end_s              REAL,                     -- end of the crash: separation or, if later, the
                                                 -- time of the largest change of velocity
    PRIMARY KEY (crash_id, role),
    CHECK ((olc_g IS NOT NULL) = (olc_status = 'value')),
    CHECK (frontal = 0 OR olc_status <> 'not_front_contact')
) STRICT, WITHOUT ROWID;
INSERT INTO crash_vehicle VALUES(384354726419890176,'a',3729556851407,955645882439,'front-front',1,'left.2','van','van',1,153.0530598915451037,149.03202492016407632,-2.5690163815198534535,-2.1684514614481145144,-1.8323435239590124545,0.46473030261554804098,2.8153629738761476453,5.5,2.0,0.13298121853658750879,'front','model',0.77605641617243392715,'value',0.07494530450485491213,0.32243717775650160284,1.9688330898336332541,1.896254055224390278,-0.52973823631929395361,3.6587109524983589814,2.3808737885487802898,NULL,3.1462061878306988305,0.27792373717577156799,-0.2528321470949137506,-0.16975886224041786265,0.043064166738669862333,0.12900000000000000355);
INSERT INTO crash_vehicle VALUES(384354726419890176,'b',3729556851407,955645882439,'front-front',1,'through.4','car','car',1,148.73821938526171492,148.40000000000000568,0.0,1.3437853187634798413,0.0,0.0,1.3437853187634798413,4.5,1.8000000000000000444,0.70555749060652728221,'front','oblique_velocity,model',1.4136121799919136865,'value',0.0676169840700957675,0.25383489194009789535,2.7107559200529713905,2.5771271800146715591,0.83962689073266216777,4.8521720586886436521,1.5576325603411069753,NULL,3.8448436189505246218,0.35486313554015574966,0.30539703227489667369,-1.0047646222044677166,0.013731441170445835009,0.12900000000000000355);
INSERT INTO crash_vehicle VALUES(882134230574825472,'a',3729556851407,2399295350932,'front-side',1,'left.1','van','van',1,156.39087099986903695,150.75143165901963016,-2.905689780896952179,-6.8227586425674378034,-3.5030958999112975504,0.72963209757649138964,7.4525404827173602484,5.5,2.0,0.0048088460962604521672,'front','opponent_structure,model',0.5473883733041667865,'value',0.081520625897982659791,0.37736043968851779029,2.408588075199576739,1.5880817855831601548,1.8096114627130195362,3.2540007359103522155,1.8293272421527373428,NULL,2.6469296352739064559,0.38436020997453962388,0.86247399595468232647,-1.3528498972005809086,0.0039024375682633061224,0.098500000000000004218);
INSERT INTO crash_vehicle VALUES(882134230574825472,'b',3729556851407,2399295350932,'front-side',0,'through.2','car','car',1,153.38162503698609384,148.40000000000000568,0.0,13.737054532411871576,0.0,0.0,13.737054532411871576,4.5,1.8000000000000000444,0.2407117187891015253,'left','contact_side,model',NULL,'not_front_contact',NULL,NULL,3.4652017539914621302,1.66495050026030178,3.04016000078344506,3.3018991767417480431,2.0042613476025916696,NULL,2.7053218811855077596,0.55767072720583521494,1.0701038969130429734,0.59637280040448714668,2.2204460492503130808e-16,0.088499999999999995337);
INSERT INTO crash_vehicle VALUES(882134230574825473,'a',3729556851407,2399295350932,'front-front',1,'left.2','van','van',1,153.11868876156722763,149.06685712144516742,-2.5756554695205160498,-7.9719577835437851476,-4.1243331137074230596,0.77012165749858141339,8.9405182797682059003,5.5,2.0,-0.29796696240067133132,'front','oblique_velocity,model',12.262519449188490128,'value',0.042259530030406999845,0.12074504586388914995,10.564291153415807045,9.4669079953078441036,-4.7614372495479315716,15.0881916032972061,9.2071186730058993674,NULL,12.290518570753116378,1.332129258647660519,-0.40491337444367481168,0.75505392485198696839,0.23210589349150004268,0.10899999999999999966);
INSERT INTO crash_vehicle VALUES(882134230574825473,'b',3729556851407,2399295350932,'front-front',1,'through.3','car','car',1,148.80210443066795278,148.40000000000000568,0.0,13.602651495506924206,0.0,0.0,13.602651495506924206,4.5,1.8000000000000000444,0.26797022166860584579,'front','oblique_velocity,model',22.290457486959112999,'value',0.037041746024461655317,0.10570280243473594017,15.196291435104624766,15.070136160604477026,1.9102004089396147357,25.483720892281581881,14.034029383336376284,NULL,19.647269506911356984,1.6394363946683814248,0.12015965676258844041,-0.83152860657056060222,0.29356916423381052005,0.10950000000000000011);
INSERT INTO crash_vehicle VALUES(1793082703738830848,'a',3729556851407,2399295350932,'front-side',1,'through.4','car','car',1,148.05584720685473598,148.40000000000000568,0.0,14.560475681428190597,0.0,0.0,14.560475681428190597,4.5,1.8000000000000000444,0.39524694491754003289,'front','oblique_velocity,opponent_structure,model',8.7405961152330355901,'value',0.043486245829514685867,0.14734665971411295415,9.2917349006216092277,8.9062359355579818753,-2.6563385419210465698,12.790705670271515614,5.7734829720175513401,NULL,8.6882720374802246965,0.7818047940581424049,-0.29381607599198567015,-0.40659905262242312939,0.13018547874459113211,0.14849999999999999311);
INSERT INTO crash_vehicle VALUES(1793082703738830848,'b',3729556851407,2399295350932,'front-side',0,'left.2','van','van',1,152.23088354868161786,148.15052529690083816,-2.3777966465422313291,-4.4158417330381194432,-6.2454430176300048671,0.69749786809853553393,7.5089627972084116436,5.5,2.0,-0.36854906213002180948,'right','oblique_velocity,contact_side,model',NULL,'not_front_contact',NULL,NULL,6.9115789635613245067,3.1494752610695400107,-6.146717426528902628,4.1786229005269124314,2.3483579374952512353,NULL,2.9263341179291884053,0.63448794829845589493,-0.99174759490182751164,-0.0139767362751554991,0.000670757649840314496,0.14749999999999999222);
INSERT INTO crash_vehicle VALUES(2875374071658315776,'a',3729556851407,955645882439,'front-side',1,'through.3','car','car',1,148.39269117196002412,148.40000000000000568,0.0,1.9581596570490207298,0.0,0.0,1.9581596570490207298,4.5,1.8000000000000000444,0.67491150537682687016,'front','oblique_velocity,opponent_structure,model',0.34833486567664634359,'value',0.10769398571087490656,0.48284336574806668851,1.3446562574883733631,1.2815095733577481773,-0.40753744273005437781,1.7156849507356233264,0.84855590197358676807,NULL,1.5182036721619658337,0.13598753868120713739,-0.30908366215636284834,-0.042487997643280789317,0.0081234241962072628595,0.153999999999999998);
INSERT INTO crash_vehicle VALUES(2875374071658315776,'b',3729556851407,955645882439,'front-side',0,'left.1','van','van',1,151.71770887488804646,147.43004407636129826,-2.2967291051391121037,-1.9927378018548997928,-2.7777981327427045954,0.31502430249712887189,3.4003069491230153431,5.5,2.0,-0.16995204307385428088,'right','contact_side,model',NULL,'not_front_contact',NULL,NULL,0.9628632734326375564,0.43389790129208005708,-0.85958408498925020779,0.55893302449664672426,0.34659019736854429494,NULL,0.51685404746740526427,0.1183536858656458468,-1.0926843712525684537,-0.55876106673489667198,0.0,0.13400000000000000799);
CREATE TABLE contact (
    replication_id     INTEGER NOT NULL REFERENCES replication (id),
    number             INTEGER NOT NULL,         -- from 0, in order of time
    time_s             REAL    NOT NULL,         -- SUMO clock of first touch
    x_m                REAL    NOT NULL,         -- first contact point, world
    y_m                REAL    NOT NULL,
    verdict            TEXT    NOT NULL CHECK (verdict IN ('graze', 'overlap_at_insertion',
                           'no_common_road', 'after_crash', 'warmup')),
    -- graze: their motion at first touch leads to no deep overlap; overlap_at_insertion: SUMO put
    -- one on top of the other; no_common_road: different levels or roads; after_crash: one of them
    -- had crashed with a third in the same step; warmup: would be a crash, but before warmup_s
    vehicle_1          TEXT    NOT NULL,         -- SUMO ids, in order of role
    vehicle_2          TEXT    NOT NULL,
    PRIMARY KEY (replication_id, number)
) STRICT, WITHOUT ROWID;
INSERT INTO contact VALUES(366549230976,0,16.545206902352699529,154.63133870822952076,149.30000000000001136,'graze','left.1','through.2');
INSERT INTO contact VALUES(1710016921748,0,16.545206902352699529,154.63133870822952076,149.30000000000001136,'graze','left.1','through.2');
CREATE TABLE sumo_collision (
    replication_id     INTEGER NOT NULL REFERENCES replication (id),
    number             INTEGER NOT NULL,         -- from 0, in order of SUMO's first report
    time_s             REAL    NOT NULL,         -- end of the step of SUMO's first report
    collider           TEXT    NOT NULL,         -- SUMO ids
    victim             TEXT    NOT NULL,
    sumo_type          TEXT    NOT NULL,         -- SUMO's word: collision, frontal, junction
    found_as           TEXT    NOT NULL CHECK (found_as IN ('crash', 'graze',
                           'overlap_at_insertion', 'no_common_road', 'after_crash', 'warmup',
                           'no_contact')),
    -- crash: confirmed by us; no_contact: the rectangles never touched; else the verdict on the
    -- contact
    PRIMARY KEY (replication_id, number)
) STRICT, WITHOUT ROWID;
INSERT INTO sumo_collision VALUES(366549230976,0,16.600000000000001421,'left.1','through.2','junction','graze');
INSERT INTO sumo_collision VALUES(1710016921748,0,16.600000000000001421,'left.1','through.2','junction','graze');
CREATE TABLE pulse (
    crash_id           INTEGER NOT NULL,
    role               TEXT    NOT NULL,
    codec              INTEGER NOT NULL,         -- way of packing and resolution, see above
    sample_interval_s  REAL    NOT NULL,         -- sample k is k intervals after first contact
    sample_count       INTEGER NOT NULL,
    samples            BLOB    NOT NULL,
    PRIMARY KEY (crash_id, role),
    FOREIGN KEY (crash_id, role) REFERENCES crash_vehicle (crash_id, role)
) STRICT, WITHOUT ROWID;
INSERT INTO pulse VALUES(384354726419890176,'a',1,0.0010000000000000000208,401,X'28b52ffd601c0dcd1100a6563f27902b1dffbfbabbfbdfdddd5d2636cdf22aea70b0efaa6dd91291b2682b69841042c8de52a69402450030003400e8ba559669898503227134105b462068dba66999e0c20458b68020a67c6987593d676125c80183da1c598854281ccd95d10a0fcc2732b14c800383624068050f08d439a01b7eef55d3d1521ca68b65cb08d85561573e2f82e000bf37faf7e6eeeddff56f5746f55f74dbf7ae6d1bdb3c3aa7e91215e928c9b9ecfff7595dd8754daf33db7cefaa3a501802014b42a36da3731245490edbe7ffccf7d7880e9d04180430a75b9691b2a4f67ddfb7efbfbf14b26f63fdb7b55bdbaedbac8daeefe5dffe6efdfbf754db75dfdb893a550f80b2a871ba9414f68f39204a312c693a6218643e1c124b482e289ff229282a7706f507af0a49b7d142608e79e6b50fa8a71d8563142bd0d8289255855b0c1c2f5cc73c32d1a77df93d3ee3704f08b298e13d72522bcb000e38458b55155d0f1293ad6c42fe9090c1158184b0f5f652128cacf4c7405d54552abfa6fb90969b479eec6dc973fdbd62ab8b21f446030d7243cd6d54ba321a707bd99700c5a1445aa68f8ff44ea11058b55e102fce4f6848cd66aea518255993ee0942d952aeb0e0907d9ee6b80d2d53ecdb519158e580324e3196a104d205ecf3b9c73713ae612ec5b574d4a8d01cb6e6ade0b13f49a6760c7b94a4adc268a71d0074cc9464a88cede70516046b5dadb78c820e2fb635e14a2ed5b1d7e2b8f2d490c15231c2297c8895acf797c05dac078dc55451bfae9abf2f9bb0bfeb2d5401');
INSERT INTO pulse VALUES(384354726419890176,'b',1,0.0010000000000000000208,401,X'28b52ffd601a0d251300c65b502010973a0000102000001514ae862dfee509a443da0938d60d724bdb6df7962905560041005000dd20dc4022c3a30f8df7c78107ac9ea7a6090a8d1002010f836e50f84209e413c898c50dcc783ae17679f59d644329dc50e15462184ef90d6886212510a1d388e37038bc18584c4b232e2e9c8987398252a54a0bcb0e74012a85409f88a252770dc8d751cd45338964ad048f4008540aa81e607ebefdf5fefbfbff7e13feeffd77fffbbbdf7b97b0f2ae6fe9dfb76dd981876b5101510b9c86c96865d9ad6dda8661d2b7320aa017b6719d80db3801376f512f00c82e2bfa5162be66a271e066ac884a69162f27d71dbe9062b1582060a19bb6b2ea21140c05a1c6c91512a0c482a1809ca96505dfafffbdfffdd7fe7e77fdf5d7fedabb5f7be5942bff95bbb6ef182fcb8a31eeee635c39edfb7f5cfff7deffeff5f7deddbdb1808ea8f1a9542765a4b4cf01400821ac69da9230540ccd609c8012125824814c249293a0bc160e8813a75c2117aafb983b0db073cd126aa8438938a1ec0f228a9413c10418301262355c72c946169c59b53a81eac0e3d3312068e1582211f20808e364148f73b8f1d5783497a0a899dd3c9e824bb0e6b205eb88abd02f7fd9cb2bf4cfa2c4dfc1fb2fde4085528b90f54afc8789eababcc897a6d9495e08493876b2b1e88fcf095d3676974e4835f78d70b3ccb0101271d8309fd70caca0e3982524064ee43696bd641c8919c9178a12be8c1f7526c24a1f0ea481232bb523eae610aa09d3574f7612afb11fac5a7c783f364034f36be42ad7d344fbf3ca445bcf435f71ed89b5b15e8bd7893bda487f32d3afd94899e9623539faf6103ca00a');
INSERT INTO pulse VALUES(882134230574825472,'a',1,0.0010000000000000000208,401,X'28b52ffd601e0dbd0d00f6563f295089930e8888c34f74555591c8cccc643283255d7a83bffb0054115545f415adf86d6d0d49233b49194100310037000ee430367324004864329908548cf635c7c680542e19cc2542b5596bcda12003556ba22972581e5275e3b487e5e995e4fc7358120985725d06d74521b01e8de71ad73e63ed6b1ac514605914cb754d006d4c5363f1dc7d73200872d8a728c310e5d77b6f1fc8b27772969d9ce56d98e045c7933fd79ddfbdfc5db26cbfbcf70e4428320e058b279a1a0e4be268dbbbe6ae37898a5430080a0b090907194c2522505514c5901cc6da6bbc2d6f272f393bcb72ce7f5e24c12876479625bf35d6d8cff92c796defee7adb969dcf0e54a0c11d84cca4f56b0e60463923690ed30d4a4e51a098c3c1f81bed857072998ce1b894243a7a70ebc5ca2d51b16bbea21b2d4c09508cf7ec01e090f253484ee59e1becca0101f372dd2b99bfdaf1c90a074c5ada6cce8870ad0c07232ebb5e86788e598adbd77a4210e255458a57c945aa9cb35da30fddcca4bd0028a10862a2a0dcaad5c1d44fa6a13cb68153af81f632869cccde764f5824f2eab5ce3285926a08ea8f0dbe562a462865847541971d25553a81ab01');
INSERT INTO pulse VALUES(882134230574825472,'b',1,0.0010000000000000000208,401,X'28b52ffd601f0d850c0006d02e1d804f074482263113a328ab992c81ad180407040626ca21864476dc32a52b001e002d00f67d0349b3244b33499304414ed32cc99224c951044310eceeff2a08b556174aa855c4200cc230eaf7d20194dcdbbefda5b6bfdf7ffdbdedef8edfbdf7bed7dfafedff34bdc465ec0359e7791db7611825414eb32447510cc1524a6b459427520841a80155bd04aba220882154ea5d0000fc6a30550c5f7fbff6d76bdffe6fafd7a6ccfeff7ebfded3dbc78465186659d4344d9234495363a8413622494acb48360e5088b11a85cd0392481c2b6529ee4840a15024b1921f890a7ab63b84a5f4ce4deaae18212c86b2e882eb0420a404c615a9b5df92feae7b202341559383ba1dbb94420bf8cb2a42eaa021f0ab7df135abfeadac3ce087b112c20631e36f4d835271fa013d04f97772525698c2eeeba2d21a54cb8a762b6143efaa57967a33f0775ab6605969dfb70729fdab6fb39d4b19e9fbb166d00d6b1513afffa41660b7c10f0c9448b461e27fe9c796ca677cb97ebd932fcc709ca613ea180b463e465124e4bbfc60e2037e');
INSERT INTO pulse VALUES(882134230574825473,'a',1,0.0010000000000000000208,201,X'28b52ffd605306851600a622783ae0dca4033024e89469e18201bc03b10c0d6010942072eb2c1b1e70e898e82a62d0723cb6a795fb9cd7b85a6c6524d9d29a3469441a2164cb2403770061006500a699aaaa6aa2c283e3c8898a4a0a4a8a4b4db2a7672759d372e21191d00a856df11882128393bc7129b968af0245814243fa338edcacdfc86e5d3977db0e3572b8a63a9687ccb74e1573e421911cb76ae1b1c3a1008fd5050b8921c6a1eeb4f2021260e65cea683dd6461b7ffba1f95db3f5d7ab14f8017697eb00eaa7f67a19d19fbe74510efcae430a51e764bfe2413ee9513015a7bb6077ea6949018cf6c0e6492f481f93b29bae180b49ef23e64c41eb9d98d9e4cb97cdfb7bbefcbfbfd5dcb7cdcb67ff67e63773c9bf67c997cfddfd2badf10abc37e8577ebff965c9dcfd0632efec7379becdb7cbee339ff772bffb679f161fbd773a1291a1689cb8c8d8a82832188f1311c5d687f283890805c402848609b2e850cf7ad7b97e75a721180c734246a8a72400e1e552577bdcb3866686ed4ffd519fddade3610fffdffd738abef928f3ccfffcbdfcdbe5cfef9926b3ef8883eb899e3db487a2e879f6bbaf99aec120cb02d7f432ea03f8f5faa62c4101bba6ef9203225a56a28362fd3118893ea1102dcb1e9a12b0ac5a1a6454107ba67a56816a5020b8b61bc28b068082a8d1c1b291821415946a74404831ac6903d219450b528a46945fe54f49372a241b36c96dcad71bae29b43971a57f786fc9f36f056b9638e9cef181f7094a10f9dfcec5abbc15b979e28e94277aedca75c273bb0baa4825ab740a17a53f6ed28f45e9b0d41510a4c3484866317f3823db59144ed67ccb45ae54553136548a0264607c09702cdf26a8416d5639d76e02f773d1fc2f384ef0a5f9ac10f952035ca303e21dc9b0494309b69185d54e2196d855f2ab30010433b8429ff3e70732e8249dffcfe0113a10bb0dec905da0cf2869c3bffe414f8f013e1a3375340ee297675de7a4980aec5507a7590d');
INSERT INTO pulse VALUES(882134230574825473,'b',1,0.0010000000000000000208,201,X'28b52ffd606c06d51600c6678139d0dea40350d81e8aed62484cf7f660b48494b22472c259f4a4034aafbff5d7d8436915c55e2dd957a4890d2532f666668dac5942c8de5ba61d800068007600ca9963fdea432f2514caa482898dcf8f0f8e0d8ecf8bde24c53cd499577a914d08f1a840cc45e4937885b9f37277eba34e6b26c0b78c372fa971d8e881c0b8f0f128a086c2495dd768f8ebde091f972f55effd79cdbaea66a2d504159ae59d6ed67d3eca4379d35cfd7c98404c487bddbc0f8c859d2e6d87f172f3c2bd2d02db603aab40ca9f1d3c4f7ad70b30a7079944c898a85840ae80046f245922616cdfbeffbe7dadbdcdcffffd4d9f3edf9b7fef7fedffdb5f7bbbc9beff7ebffbf7e805dee3dfbfdf4673da287a7d8d338aed9f7177dbb47f6a4ef32dc6d67ecd69db5a8818208b56c5017f5b7c14676cf3f12dda7fdffbbb7dfb77ffb6dff6dd163b08bdf9aa132d073082aef5b2b35daf99adf4b74b696c1ce9cd4fedac804c18fbc870c181d170407c707889101717120d120d42a586d2a1e65efdd46addd664a7bb89d0e9bd3e6ba576e2bcf9b19381e5b2e5736d258332822240889d8925efffefdbfebbbb9f6fb1ed5b14dbeedf5e6010e84b8faeab10e0980c0058d10c1c0683699a7fdc6dff7b8b518c1b773746ad4d8746e48080eff8b70614a8c3e26d8b1f0ce2f5677db95115fd1185eab3aff85548fc596030f72dc69d813edb7df3d5ffddfdf70364a8a1c553131494242525852c07504631236d1ef260bc9053945825120ae57fa49c1d0ea024f64ce251989e7afcee88b755b650586410713504d59e9aa34f5286b3af49a5883959cb9b3aac1e206e96f0bc2b781bfc0ccf9e2f85d94337d9abaf0c6b20010364de9e940a2b58db743064f245ae26ee7179aad43f08b88692a5c369f2704824f784e1293405116766a2cc78393193d5e5f961a03bb3e04c4e3709e04b1c0754132f9bc1be42ce8fd11ab91560398292c1cce86cee68f7d8c292d9f016e4ba07cae70d4a59936fc407ad5515');
INSERT INTO pulse VALUES(1793082703738830848,'a',1,0.0010000000000000000208,401,X'28b52ffd60410d151800c623773a0079d201fcffdf0cfaffffaf7e60138191dc850975d8da8e02768823836356881c1a856d68d0c672b0ded5b6a16ccbda22462c2184ecbdb74c327400590079003f0c88dd79beec0ce05efb0392969f00a5b08153563bc93ade5982ce65f6020c0e5a000dbf00178d7b322ea3240586662662947839d3ab2e747b5477b370aab63a528ca2e9540d4a7901c3afac54753a92bdb1cf170298310a82fce853bdf326de68d245ad147654ffc49e4577284ffbd4cc9a031007ea9f1be53e3e7627c449ccc857f8cd3f9f299f4f99fe7cfe9969bfdf49ef77d33effdc7fad6cb9a9488615a4cccdef66fabe4dff7737f3b1a4b896b5b9993fd67204b2b33670c24a721c6fedaee1083b7d181e211f1d011e2dd115b3e16c361acd46eb2520f07438d365bb940de40c7204b2f25a97699a33d7cb1a8c2c6104bedd8b06dc703a9e8ed72bb8dd6c33cb67830585c24e41a0862429da166e61e222a382079e122ad76159c19178cf4e241b64282922273a54cecc0a47dbfce9422416161b0efd3a68da83cc87bef4a31933e7e6f7b99b7633e5eeff6d6bffca2ed3333dedbeb59efedc955a2b82a2b55dc31246826025992f594510346d2d5104eb592bc35aef65ee9fb662b1998b76f80a2b49d653eeaee7faeef7dfefd3ee66ee0bb2eb77aa80a1a861ae296939054965e720863968930ec2a0a01623aaa90a4482943fe557d20159cfe1d9824ba1cefbb28175d1127842b016783338e330bb7469b1326803aef89d25e6e278347813fa44146b3af98debc1eccd2c396d286dc416f31534c0f955fb9c7de379298c48b92dad819902da9d4b452dc44b6f8235d5978e24bc1d2f2c1672981380e41e69752027c07d045a5658610c06d88cf26c07fb431fe04b13f89821d0b2d8a770992187d851c7108a51ce9fa816c5c1a6f09f5530ab9e83ea6e594fad071f7ee99ee582238a68134fa0442b6f82e557c7cbd18c727e16508e59e3ecbdf5cd9e1de0936a1c8357febb35e7d31ce7a66e143d2d22f1de5127a64eb0dc4953daf6d5fe270c582717a7a9492df86e1f381d3cc8efa0ff36d547e1d3ab');
INSERT INTO pulse VALUES(1793082703738830848,'b',1,0.0010000000000000000208,401,X'28b52ffd60320d5d1700762374391075d3010080148082720f09102a14010c6754302844fa6a91a74297d41469aa537b5abcfaffbda2d1ecffbfc6ae898888888890bdf79649066e0065006500dad5348df33cce03459224cb95c06a953a9d4a52244da056c155c96a55d1a361d7a208821ea7d5dafdeee65a99edc44548cd0ed52d3d3733cd0a5c582c48d5c44749877762fa8f4aca84666645c422f5bd5eaaae7aa2583501898fd77c360ccf880a86582c0673119c2c95f9d107292933fcc2f0cb582b214e6e03e3719f91817103e565a0777e4472409ac0d1e13ca15c4885f58707b5d27b465a6e749d96171de93e31041007a2375702202d40344e0b281927aa43dce7feffa6fcfe73f8fdfffd7e37d3bebddc323cdc5debeb3377bdf506dcddcc02dcfceee66edad5bedf5c69655bb9996b77977f6db7f6355f2e933853388ec2466db6755d18a0629d67abd572b95e30d80bf672bd5c2e04870686188ce034c38cd22a969c650a0cb16b69b0ea700408c7afb399a534fbc21175b2502647884579017fbffbdce777d3db4cafb5b5bbe7426e897f4df7dcf5de5a2fa76d5dd7eedf5afb7d19cd367b4ae999af488276ecd86e19ada2c769dcbd7dca5f4077d64c0662b68da689529961d6a684d2bedecaf6db4a0ce6bfbe5ff9358093a8f1b525246515142ad31830883134857452903c12990892910a24a4a0fc9f14946e20ab07135021bf7504386079b043fc92513a3d911d843e232d13e23aa191c1580d7ab4310896796085b019eee6e926b6ee7fc09c91bd376581de0c8b7d45e1400666bbf49274be4b778b209dad83483108d3d37fea26f4671275a4da232bed1e9900aec321a08a6696116e141e80e4fdec211637589d1b7cdb45e02d8c08870b271a94ea8826372fc49b444fcb36224e9b0e40fd8cddd5a1b18fc183d570c8a75ec8c7e2400f9bff63723e36e40055e8ee8c20c3cb69147fbe4538dd5ef1aaee84b82a7e554cf0edab553e30b705e0cdb29c8479a298e9007d48e2590483c09ec2f14388842b8cc381cea2406cd6d42035f0812a');
INSERT INTO pulse VALUES(2875374071658315776,'a',1,0.0010000000000000000208,401,X'28b52ffd601a0dfd0d00b20f261f902bc301ffffff7faabf5fc4c88cbb0bd71b5af4a26d8d04114236d944a614fffecdedffb6b6cd9fea76eb7b6e733be74f2544416a20c2b4d4024c9361727be7661704ada5fce9b64dad456e6dde6ef5b921ceddeabd75f79c3232de90ac819189c24119542e1541c282b1384ad7958216048016b4a6d4526a0a5a53090802f5cdafbe374de3448f14494fe43ccef3b8261d1c8f45a0d18097a821323b696a64630c308631bb0569033260780c2f70080b88822498406227906082f249e906a6f216c3e41d7fe1a984c5028991645e5b59205a01202a387b01b7ccafb89f18b3d55e7f24d0572515845bdc8806b0b11c9268d9e7a03347af87fc2e986b0893439b3699c0465d99d25af09d363204eca0a95679762098ae8bc673e698b0356b1af08fb70ed3d30100ed0fc393e322814d089743d89eb3c5bb59fc3260c6668c9eb4ae288e39680f3efd738246818142ed5a9a2721246c66e8680c1bc9eefa1239da4454e470fddc566cf848df6d821c7b0ef5352dccdd88ab69f4fb21a3310d916c269c68bfcac3b62cda72b0cdf3fa61b20b71a1d50c72613fc8d2718a7b9d2514a4b4cee8041c10ffd5a03a7a74de6893e10a000af7c2280aa055');
INSERT INTO pulse VALUES(2875374071658315776,'b',1,0.0010000000000000000208,401,X'28b52ffd601c0d150b0096d61d16c0a5d201ffbffe7ffbff7f7d053e70605a238d10b95316001d0015009ff79f9be6cecba7c26191f9ab517dfb9ea748d138180720761e4091c92759668d234320388ea340082fd39465c3b6cfe94f0b6724dae5297da7d449309ff97d2f335deef92c4d0793e7cf7e7796f73ed393f6bc79bae572b9017ba811266422050625e5ca1a608ae149a1037250102b811808860b442211092594180945a214e4031e23156539c01efcc1c35a95b8b62b3b705823b155a2c22e29074e39a160c6fe23d43013f8ee4816e8e0fe4f025207c4e2b731cb3828eb8e690f8fdb9b47314ee9d871deef2c3418bb7b483a734e11ec3bd58c47552af57bb5c4470b151de967712ace93a427126594419bbd9f6380c8d05f716260a7703b0af3054f7bc08688035d5821ec0c8412784033f0c6942d9571a340e89c1528587518469c08ea05466ba8efef6fdc721599f8b8b1e0ad7153ff38383dbdb0795087de6bbb0a399f02');
CREATE INDEX replication_status ON replication (status);
CREATE INDEX replication_variant ON replication (variant_id, scenario_id, number);
CREATE INDEX crash_vehicle_variant ON crash_vehicle (variant_id, role, olc_g);
CREATE INDEX crash_vehicle_olc ON crash_vehicle (variant_id, olc_g)
    WHERE olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s');
CREATE TRIGGER crash_vehicle_copies BEFORE INSERT ON crash_vehicle
WHEN NOT EXISTS (
    SELECT 1 FROM crash AS c JOIN replication AS r ON r.id = c.replication_id
    WHERE c.id = NEW.crash_id AND c.crash_type = NEW.crash_type
      AND r.scenario_id = NEW.scenario_id AND r.variant_id = NEW.variant_id)
BEGIN
    SELECT RAISE(ABORT, 'crash_vehicle: scenario_id, variant_id or crash_type is not its crash''s');
END;
CREATE TRIGGER crash_vehicle_copies_stay
BEFORE UPDATE OF crash_id, scenario_id, variant_id, crash_type ON crash_vehicle
BEGIN
    SELECT RAISE(ABORT, 'crash_vehicle: crash_id, scenario_id, variant_id and crash_type are fixed');
END;
CREATE TRIGGER crash_stays BEFORE UPDATE OF id, replication_id, crash_type ON crash
BEGIN
    SELECT RAISE(ABORT, 'crash: id, replication_id and crash_type are fixed');
END;
CREATE TRIGGER replication_stays BEFORE UPDATE OF id, scenario_id, variant_id, sweep, seed ON replication
BEGIN
    SELECT RAISE(ABORT, 'replication: id, scenario_id, variant_id, sweep and seed are fixed');
END;
CREATE VIEW crash_list AS
SELECT s.name AS scenario, v.name AS variant, r.number AS replication, r.seed AS seed, c.*,
       c.crash_type LIKE 'front-%' AS frontal
FROM crash AS c
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id;
CREATE VIEW frontal_vehicle AS
SELECT s.name AS scenario, v.name AS variant, r.number AS replication, r.seed AS seed,
       r.id AS replication_id, c.time_s AS time_s, c.closing_speed_m_s AS closing_speed_m_s,
       c.lateral_offset_m AS lateral_offset_m, c.angle_rad AS angle_rad,
       c.overlap_1 AS overlap_1, cv.*,
       cv.olc_status IN ('no_deceleration', 'beyond_0_5_s') AS censored
FROM crash_vehicle AS cv
JOIN crash AS c ON c.id = cv.crash_id
JOIN replication AS r ON r.id = c.replication_id
JOIN scenario AS s ON s.id = cv.scenario_id
JOIN variant AS v ON v.id = cv.variant_id
WHERE cv.frontal = 1;
CREATE VIEW olc_by_variant AS
WITH ordered AS (
    SELECT variant_id, olc_g,
           row_number() OVER (PARTITION BY variant_id ORDER BY olc_g) AS place,
           count(*) OVER (PARTITION BY variant_id ORDER BY olc_g
               ROWS BETWEEN UNBOUNDED PRECEDING AND UNBOUNDED FOLLOWING) AS n
    FROM crash_vehicle
    WHERE olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s')
), median AS (
    -- the middle one or the mean of the two in the middle; no value if either is censored
    SELECT variant_id, CASE WHEN count(olc_g) = count(*) THEN avg(olc_g) END AS olc_median_g
    FROM ordered
    WHERE place IN ((n + 1) / 2, n / 2 + 1)
    GROUP BY variant_id
), vehicles AS (
    SELECT variant_id,
           sum(role = 'a') AS crashes,
           sum(role = 'a' AND frontal = 1) AS frontal_crashes,
           sum(frontal) AS frontal_vehicles,
           sum(frontal = 1 AND olc_status IN ('no_deceleration', 'beyond_0_5_s')) AS censored,
           sum(frontal = 1 AND olc_status = 'simulation_failed') AS simulation_failed,
           sum(frontal = 1 AND validity = 'inside') AS inside_validity,
           avg(CASE WHEN frontal = 1 THEN olc_g END) AS olc_mean_g,
           min(CASE WHEN frontal = 1 THEN olc_g END) AS olc_min_g,
           max(CASE WHEN frontal = 1 THEN olc_g END) AS olc_max_g
    FROM crash_vehicle
    GROUP BY variant_id
)
SELECT v.name AS variant, v.id AS variant_id, v.is_baseline AS is_baseline,
       coalesce(x.crashes, 0) AS crashes,
       coalesce(x.frontal_crashes, 0) AS frontal_crashes,
       coalesce(x.frontal_vehicles, 0) AS frontal_vehicles,
       coalesce(x.censored, 0) AS censored,
       coalesce(x.simulation_failed, 0) AS simulation_failed,
       m.olc_median_g AS olc_median_g,
       x.olc_mean_g AS olc_mean_g, -- of the vehicles with a value only
       x.olc_min_g AS olc_min_g, x.olc_max_g AS olc_max_g,
       coalesce(x.inside_validity, 0) AS inside_validity,
       1.0 * x.inside_validity / nullif(x.frontal_vehicles, 0) AS share_inside_validity
FROM variant AS v
LEFT JOIN vehicles AS x ON x.variant_id = v.id
LEFT JOIN median AS m ON m.variant_id = v.id
ORDER BY v.number
;
CREATE VIEW olc_by_scenario AS
WITH ordered AS (
    SELECT variant_id, scenario_id, olc_g,
           row_number() OVER (PARTITION BY variant_id, scenario_id ORDER BY olc_g) AS place,
           count(*) OVER (PARTITION BY variant_id, scenario_id) AS n
    FROM crash_vehicle
    WHERE olc_status IN ('value', 'no_deceleration', 'beyond_0_5_s')
), median AS (
    SELECT variant_id, scenario_id,
           CASE WHEN count(olc_g) = count(*) THEN avg(olc_g) END AS olc_median_g
    FROM ordered
    WHERE place IN ((n + 1) / 2, n / 2 + 1)
    GROUP BY variant_id, scenario_id
), vehicles AS (
    SELECT variant_id, scenario_id,
           sum(role = 'a') AS crashes,
           sum(role = 'a' AND frontal = 1) AS frontal_crashes,
           sum(frontal) AS frontal_vehicles,
           sum(frontal = 1 AND olc_status IN ('no_deceleration', 'beyond_0_5_s')) AS censored,
           sum(frontal = 1 AND validity = 'inside') AS inside_validity
    FROM crash_vehicle
    GROUP BY variant_id, scenario_id
)
SELECT s.name AS scenario, v.name AS variant, s.id AS scenario_id, v.id AS variant_id,
       coalesce(x.crashes, 0) AS crashes,
       coalesce(x.frontal_crashes, 0) AS frontal_crashes,
       coalesce(x.frontal_vehicles, 0) AS frontal_vehicles,
       coalesce(x.censored, 0) AS censored,
       m.olc_median_g AS olc_median_g,
       coalesce(x.inside_validity, 0) AS inside_validity,
       1.0 * x.inside_validity / nullif(x.frontal_vehicles, 0) AS share_inside_validity
FROM scenario AS s CROSS JOIN variant AS v
LEFT JOIN vehicles AS x ON x.variant_id = v.id AND x.scenario_id = s.id
LEFT JOIN median AS m ON m.variant_id = v.id AND m.scenario_id = s.id
ORDER BY s.number, v.number;
CREATE VIEW replication_crashes AS
SELECT r.id AS replication_id, s.name AS scenario, v.name AS variant, r.scenario_id AS scenario_id,
       r.variant_id AS variant_id, r.number AS replication, r.seed AS seed,
       r.vehicle_km AS vehicle_km, r.vehicle_h AS vehicle_h, r.simulated_s AS simulated_s,
       (SELECT count(*) FROM crash AS c WHERE c.replication_id = r.id) AS crashes,
       (SELECT count(*) FROM crash AS c
        WHERE c.replication_id = r.id AND c.crash_type LIKE 'front-%') AS frontal_crashes
FROM replication AS r
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id
WHERE r.status = 'done'
ORDER BY s.number, v.number, r.number;
CREATE VIEW crash_rate_by_variant AS
SELECT v.name AS variant, v.id AS variant_id, v.is_baseline AS is_baseline,
       count(x.replication_id) AS replications,
       coalesce(sum(x.crashes), 0) AS crashes,
       coalesce(sum(x.frontal_crashes), 0) AS frontal_crashes,
       coalesce(sum(x.vehicle_km), 0.0) AS vehicle_km,
       coalesce(sum(x.vehicle_h), 0.0) AS vehicle_h,
       1e6 * sum(x.crashes) / nullif(sum(x.vehicle_km), 0.0) AS crashes_per_million_km,
       1e6 * sum(x.frontal_crashes) / nullif(sum(x.vehicle_km), 0.0)
           AS frontal_crashes_per_million_km
FROM variant AS v
LEFT JOIN replication_crashes AS x ON x.variant_id = v.id
GROUP BY v.id
ORDER BY v.number;
CREATE VIEW crash_rate_by_scenario AS
SELECT s.name AS scenario, v.name AS variant, s.id AS scenario_id, v.id AS variant_id,
       count(x.replication_id) AS replications,
       coalesce(sum(x.crashes), 0) AS crashes,
       coalesce(sum(x.frontal_crashes), 0) AS frontal_crashes,
       coalesce(sum(x.vehicle_km), 0.0) AS vehicle_km,
       coalesce(sum(x.vehicle_h), 0.0) AS vehicle_h,
       1e6 * sum(x.crashes) / nullif(sum(x.vehicle_km), 0.0) AS crashes_per_million_km,
       1e6 * sum(x.frontal_crashes) / nullif(sum(x.vehicle_km), 0.0)
           AS frontal_crashes_per_million_km
FROM scenario AS s CROSS JOIN variant AS v
LEFT JOIN replication_crashes AS x ON x.variant_id = v.id AND x.scenario_id = s.id
GROUP BY s.id, v.id
ORDER BY s.number, v.number;
CREATE VIEW crash_type_by_variant AS
SELECT v.name AS variant, c.crash_type AS crash_type, count(*) AS crashes,
       sum(c.validity = 'inside') AS inside_validity,
       avg(c.closing_speed_m_s) AS closing_speed_mean_m_s
FROM crash AS c
JOIN replication AS r ON r.id = c.replication_id
JOIN variant AS v ON v.id = r.variant_id
GROUP BY v.id, c.crash_type
ORDER BY v.number, c.crash_type;
CREATE VIEW sumo_collision_check AS
SELECT s.name AS scenario, v.name AS variant, count(*) AS reported_by_sumo,
       sum(x.found_as = 'crash') AS matched,
       sum(x.found_as NOT IN ('crash', 'no_contact')) AS explained,
       sum(x.found_as = 'no_contact') AS unexplained
FROM sumo_collision AS x
JOIN replication AS r ON r.id = x.replication_id
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id
GROUP BY s.id, v.id
ORDER BY s.number, v.number;
CREATE VIEW progress AS
SELECT s.name AS scenario, v.name AS variant, count(*) AS replications,
       sum(r.status = 'done') AS done, sum(r.status = 'running') AS running,
       sum(r.status = 'failed') AS failed, sum(r.status = 'planned') AS planned
FROM replication AS r
JOIN scenario AS s ON s.id = r.scenario_id
JOIN variant AS v ON v.id = r.variant_id
GROUP BY s.id, v.id
ORDER BY s.number, v.number;
COMMIT;
PRAGMA application_id = 1129335891; PRAGMA user_version = 1;
