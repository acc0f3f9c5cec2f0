# SPDX-License-Identifier: Apache-2.0
"""Small profiles of each version, written for these tests. They use each kind of element once."""

from __future__ import annotations

RTC_SPACES = ('xmlns:rtc="http://www.openrtp.org/namespaces/rtc" xmlns:rtcDoc="http://www.openrtp.org/namespaces/rtc_doc" '
              'xmlns:rtcExt="http://www.openrtp.org/namespaces/rtc_ext" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"')  # fmt: skip
RTS_SPACES = ('xmlns:rts="http://www.openrtp.org/namespaces/rts" xmlns:rtsExt="http://www.openrtp.org/namespaces/rts_ext" '
              'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"')  # fmt: skip

RTC_03 = f"""<?xml version="1.0" encoding="UTF-8"?>
<!-- a motor -->
<rtc:RtcProfile rtc:version="0.3" rtc:id="RTC:Mamori:test:Motor:1.0.0" {RTC_SPACES}>
  <rtc:BasicInfo xsi:type="rtcExt:basic_info_ext" rtc:name="Motor" rtc:vendor="Mamori" rtc:category="test" rtc:version="1.0.0" rtc:description="a motor"
      rtc:componentType="STATIC" rtc:activityType="PERIODIC" rtc:componentKind="DataFlowComponent" rtc:maxInstances="2" rtc:rtcType="t"
      rtc:executionType="PeriodicExecutionContext" rtc:executionRate="1000.0" rtc:abstract="モータ" rtcExt:saveProject="Motor" rtc:hardwareProfile=""
      rtc:creationDate="2026-01-02T03:04:05.000+09:00" rtc:updateDate="2026-01-02T03:04:05Z">
    <rtcDoc:Doc rtcDoc:description="d" rtcDoc:inout="i" rtcDoc:algorithm="a" rtcDoc:creator="c" rtcDoc:license="l" rtcDoc:reference="r"/>
    <rtcExt:VersionUpLogs>first</rtcExt:VersionUpLogs>
    <rtcExt:VersionUpLogs>second</rtcExt:VersionUpLogs>
    <rtcExt:Properties rtcExt:name="FSM" rtcExt:value="true"/>
  </rtc:BasicInfo>
  <rtc:Actions>
    <rtc:OnInitialize rtc:implemented="true"/>
    <rtc:OnExecute xsi:type="rtcDoc:action_status_doc" rtc:implemented="true">
      <rtcDoc:Doc rtcDoc:description="moves" rtcDoc:preCondition="p" rtcDoc:postCondition="q"/>
    </rtc:OnExecute>
  </rtc:Actions>
  <rtc:ConfigurationSet>
    <rtc:Configuration xsi:type="rtcExt:configuration_ext" rtc:name="gain" rtc:type="double" rtc:defaultValue="1.5" rtc:unit="1" rtcExt:variableName="m_gain">
      <rtc:Constraint><rtc:ConstraintUnitType><rtc:propertyIsBetween>
        <rtc:LowerBoundary>0</rtc:LowerBoundary><rtc:UpperBoundary>2</rtc:UpperBoundary>
      </rtc:propertyIsBetween></rtc:ConstraintUnitType></rtc:Constraint>
      <rtcDoc:Doc rtcDoc:dataname="n" rtcDoc:defaultValue="v" rtcDoc:description="d" rtcDoc:unit="u" rtcDoc:range="r" rtcDoc:constraint="c"/>
      <rtcExt:Properties rtcExt:name="__widget__" rtcExt:value="slider.0.01"/>
    </rtc:Configuration>
  </rtc:ConfigurationSet>
  <rtc:DataPorts xsi:type="rtcExt:dataport_ext" rtc:name="speed" rtc:portType="DataInPort" rtc:type="RTC::TimedDouble" rtcExt:variableName="in"
      rtcExt:position="LEFT">
    <rtcDoc:Doc rtcDoc:description="d" rtcDoc:type="t" rtcDoc:number="1" rtcDoc:semantics="s" rtcDoc:unit="u" rtcDoc:occerrence="o" rtcDoc:operation="p"/>
  </rtc:DataPorts>
  <rtc:DataPorts xsi:type="rtcExt:dataport_ext" rtc:name="event" rtc:portType="EventPort" rtc:type="Any" rtcExt:position="LEFT">
    <rtc:Event xsi:type="rtcDoc:event_doc" rtc:name="go" rtc:source="A" rtc:target="B"><rtcDoc:Doc rtcDoc:unit="u"/></rtc:Event>
  </rtc:DataPorts>
  <rtc:ServicePorts xsi:type="rtcExt:serviceport_ext" rtc:name="service" rtcExt:position="RIGHT">
    <rtc:ServiceInterface xsi:type="rtcExt:serviceinterface_ext" rtc:name="reset" rtc:direction="Provided" rtc:type="Reset" rtc:instanceName="r"
        rtc:idlFile="Reset.idl" rtcExt:variableName="m_reset">
      <rtcDoc:Doc rtcDoc:description="d" rtcDoc:docArgument="a" rtcDoc:docReturn="r" rtcDoc:docException="e"
        rtcDoc:docPreCondition="p" rtcDoc:docPostCondition="q"/>
    </rtc:ServiceInterface>
    <rtcDoc:Doc rtcDoc:description="d" rtcDoc:ifdescription="i"/>
  </rtc:ServicePorts>
  <rtc:Language xsi:type="rtcExt:language_ext" rtc:kind="C++">
    <rtcExt:targets rtcExt:langVersion="17" rtcExt:os="Linux" rtcExt:other="o" rtcExt:cpuOther="c">
      <rtcExt:osVersions>12</rtcExt:osVersions>
      <rtcExt:cpus>x86-64</rtcExt:cpus>
      <rtcExt:libraries rtcExt:name="Eigen" rtcExt:version="3" rtcExt:other="i"/>
    </rtcExt:targets>
  </rtc:Language>
</rtc:RtcProfile>
"""
RTC_02 = (RTC_03.replace('version="0.3"', 'version="0.2"').replace("EventPort", "DataOutPort")
          .replace('rtc:idlFile="Reset.idl"', 'rtc:idlFile="Reset.idl" rtc:path="idl"')
          .replace('<rtc:Event xsi:type="rtcDoc:event_doc" rtc:name="go" rtc:source="A" rtc:target="B"><rtcDoc:Doc rtcDoc:unit="u"/></rtc:Event>', "")
          .replace("  <rtc:Language", '  <rtc:Parameters rtc:name="rate" rtc:defaultValue="5"/>\n  <rtc:Language'))  # fmt: skip
_SLOTS = "Initialize Finalize Startup Shutdown Activated Deactivated Aborting Error Reset Execute StateUpdate RateChanged"
RTC_01 = f"""<?xml version="1.0" encoding="UTF-8"?>
<rtc:RtcProfile rtc:version="0.1" rtc:id="RTC:Mamori.test.Motor:1.0.0" {RTC_SPACES}>
  <rtc:BasicInfo xsi:type="rtcExt:basic_info_ext" rtc:name="Motor" rtc:vendor="Mamori" rtc:category="test" rtc:version="1.0.0"
      rtc:componentType="STATIC" rtc:activityType="PERIODIC" rtc:componentKind="DataFlowComponent" rtc:executionType="PeriodicExecutionContext"
      rtc:creationDate="2008-01-02T03:04:05" rtc:updateDate="2008-01-02T03:04:05">
    <rtcExt:VersionUpLog>first</rtcExt:VersionUpLog>
  </rtc:BasicInfo>
  <rtc:Actions>{"".join(f'<rtc:On{name} rtc:implemented="false"/>' for name in _SLOTS.split())}</rtc:Actions>
  <rtc:DataPorts xsi:type="rtcExt:dataport_ext" rtc:name="speed" rtc:portType="DataInPort" rtc:type="RTC::TimedDouble" rtc:subscriprionType="New"
      rtcExt:varname="in" rtcExt:position="left"/>
  <rtc:Language><rtc:Java><rtc:library>x.jar</rtc:library></rtc:Java></rtc:Language>
</rtc:RtcProfile>
"""


def make_component(name: str, id_: str, ports: str = "in out") -> str:
    lines = [f'    <rts:DataPorts xsi:type="rtsExt:dataport_ext" rts:name="{port}" rtsExt:visible="true"/>' for port in ports.split()]
    return "\n".join([
        f'  <rts:Components xsi:type="rtsExt:component_ext" rts:id="{id_}" rts:pathUri="localhost/{name}.rtc" rts:instanceName="{name}" rts:isRequired="true" '
        'rts:compositeType="None" rts:activeConfigurationSet="default" rtsExt:visible="true">', *lines,
        '    <rts:ConfigurationSets rts:id="default"><rts:ConfigurationData rts:name="gain" rts:data="1.50"/></rts:ConfigurationSets>',
        '    <rts:ExecutionContexts xsi:type="rtsExt:execution_context_ext" rts:id="0" rts:kind="PERIODIC" rts:rate="1000.0"/>',
        '    <rtsExt:Location rtsExt:x="1" rtsExt:y="2" rtsExt:height="-1" rtsExt:width="-1" rtsExt:direction="RIGHT"/>',
        '    <rtsExt:Properties rtsExt:name="place" rtsExt:value="left: 1"/>', "  </rts:Components>"])  # fmt: skip


MOTOR, SENSOR = "RTC:Mamori:test:Motor:1.0.0", "RTC:Mamori:test:Sensor:1.0.0"
RTS_02 = f"""<?xml version="1.0" encoding="UTF-8"?>
<rts:RtsProfile xsi:type="rtsExt:rts_profile_ext" rts:id="RTSystem:Mamori:Drive:1.0.0" rts:version="0.2" rts:abstract="ドライブ" rtsExt:comment="c"
    rts:creationDate="2026-01-02T03:04:05.250+09:00" rts:updateDate="2026-01-02T03:04:05" {RTS_SPACES}>
{make_component("Sensor0", SENSOR)}
{make_component("Motor0", MOTOR)}
  <rts:Groups rts:groupId="g"><rts:Members rts:componentId="{MOTOR}" rts:instanceName="Motor0"/></rts:Groups>
  <rts:DataPortConnectors xsi:type="rtsExt:dataport_connector_ext" rts:connectorId="c1" rts:name="line" rts:dataType="IDL:RTC/TimedDouble:1.0"
      rts:interfaceType="corba_cdr" rts:dataflowType="push" rts:subscriptionType="new" rts:pushInterval="0.0">
    <rts:sourceDataPort xsi:type="rtsExt:target_port_ext" rts:componentId="{SENSOR}" rts:instanceName="Sensor0" rts:portName="Sensor0.out">
      <rtsExt:Properties rtsExt:name="COMPONENT_PATH_ID"/>
    </rts:sourceDataPort>
    <rts:targetDataPort xsi:type="rtsExt:target_port_ext" rts:componentId="{MOTOR}" rts:instanceName="Motor0" rts:portName="Motor0.in"/>
  </rts:DataPortConnectors>
  <rts:StartUp>
    <rts:targets xsi:type="rtsExt:condition_ext" rts:sequence="1">
      <rts:WaitTime rts:waitTime="100"/>
      <rts:TargetComponent rts:componentId="{MOTOR}" rts:instanceName="Motor0" rts:id="0"/>
    </rts:targets>
    <rts:targets rts:sequence="2">
      <rts:Preceding rts:timeout="100" rts:sendingTiming="SYNC">
        <rts:PrecedingComponents rts:componentId="{MOTOR}" rts:instanceName="Motor0" rts:id="0"/>
      </rts:Preceding>
      <rts:TargetComponent rts:componentId="{SENSOR}" rts:instanceName="Sensor0" rts:id="0"/>
    </rts:targets>
  </rts:StartUp>
  <rtsExt:VersionUpLogs>first: 1</rtsExt:VersionUpLogs>
  <rtsExt:Properties rtsExt:name="p" rtsExt:value="true"/>
  <rtsExt:Systems rtsExt:path="other.xml"/>
</rts:RtsProfile>
"""
RTS_01 = f"""<?xml version="1.0"?>
<rts:RTSystemProfile rts:id="RTSystem:Mamori:1.0" rts:version="0.1" rts:creationDate="2008-01-02T03:04:05" rts:updateDate="2008-01-02T03:04:05" {RTS_SPACES}>
  <rts:Component rts:id="RTC:Mamori.test.Motor:1.0.0" rts:pathUri="a" rts:instanceName="Motor0" rts:isRequired="true" rts:compositeType="AllShared">
    <rts:StartUp rts:sequence="1"><rts:Condition><rts:WaitTime>PT1S</rts:WaitTime></rts:Condition></rts:StartUp>
    <rts:ExecutionContexts rts:kind="PERIODIC" rts:rate="1000.0"/>
    <rts:DataPorts rts:name="out">
      <rts:DataPortConnectors rts:connectorId="c" rts:name="n" rts:dataType="TimedLong" rts:interfaceType="CORBA_Any" rts:dataflowType="Push">
        <rts:targetDataPort rts:componentId="RTC:Mamori.test.Motor:1.0.0" rts:instanceName="Motor0" rts:portName="in"/>
      </rts:DataPortConnectors>
    </rts:DataPorts>
    <rts:DataPorts rts:name="in"/>
  </rts:Component>
</rts:RTSystemProfile>
"""
SAMPLES = {"rtc_0_3.xml": RTC_03, "rtc_0_2.xml": RTC_02, "rtc_0_1.xml": RTC_01, "rts_0_2.xml": RTS_02, "rts_0_1.xml": RTS_01}
CONF = b"""\xef\xbb\xbf# manager\r
corba.nameservers: localhost\r
manager.modules.load_path: ./, \\\r
\t\t../lib\r
\r
! old\r
manager.components.preconnect: a.out?port=b.in, \\\r
# between\r
  b.out?port=c.in\r
example.Motor.conf.default.gain=1.0\r
manager.components.precreate: \r
logger.enable: NO"""
